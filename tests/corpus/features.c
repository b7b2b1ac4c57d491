/* SPDX-License-Identifier: MIT
 *
 * features PICTURE.ppm... - prints, as CSV for tests/corpus/fit, what the
 * finder measures of each region that may be a lamp. Columns: the picture and
 * its size; the threshold level at which the region was found, and the cost
 * that is subtracted from the score at this level; box, centroid (pixels) and
 * number of pixels of the region; the measures of enum glint_evidence; and the
 * score that the library gives.
 */
#include "lamps/lamp_finder.h"
#include "ppm.h"

static void print_lamp_candidate(const char *name,
                                 const struct glint_lamp_finder *f,
                                 const struct glint_candidate *c)
{
    const struct glint_region *sum = &c->sum;
    int32_t x_q8, y_q8;

    glint_region_compute_centroid(sum, &x_q8, &y_q8);
    printf("%s,%d,%d,%d,%d,%d,%d,%d,%d,%.2f,%.2f,%d", name, f->cfg.width,
           f->cfg.height, c->level, (int)f->level[c->level].cost_q8,
           (int)sum->x0, (int)sum->y0, (int)sum->x1, (int)sum->y1, x_q8 / 256.0,
           y_q8 / 256.0, (int)sum->area);
    for (int i = 0; i < EVIDENCES; i++)
        printf(",%d", (int)c->evidence_q8[i]);
    printf(",%d\n", (int)c->score_q8);
}

static void score_lamp_candidates(struct glint_lamp_finder *f)
{
    const struct glint_score all = {
        &f->bright, f->white, f->cfg.width, f->cfg.height, f->level, 0, 0};

    glint_score_score_candidates(&all, f->candidate, f->order, f->n);
}

static int print_lamp_candidates(const char *name,
                                 const struct glint_image *image)
{
    struct glint_lamp_finder_config cfg;
    struct glint_lamp_finder *f;
    void *mem = NULL;
    size_t bytes;

    glint_lamp_finder_defaults(&cfg, image->width, image->height);
    bytes = glint_lamp_finder_bytes(&cfg);
    if (posix_memalign(&mem, 64, bytes) != 0 ||
        glint_lamp_finder_init(&f, &cfg, mem, bytes) != GLINT_OK) {
        fprintf(stderr, "%s: no finder for this size\n", name);
        free(mem);
        return 1;
    }
    glint_lamps_collect_candidates(f, image);
    score_lamp_candidates(f);
    for (int i = 0; i < f->n; i++)
        print_lamp_candidate(name, f, &f->candidate[f->order[i]]);
    free(mem);
    return 0;
}

int main(int argc, char **argv)
{
    struct glint_image image;
    int code = 0;

    puts("file,width,height,level,cost,x0,y0,x1,y1,x,y,area,around,halo,spread,"
         "fill,box,size,colour,dim,close,white,crowd,high,wide_halo,"
         "wide_hot,dark_2,dark_4,dark_32,drawn,"
         "score");
    for (int i = 1; i < argc && code == 0; i++) {
        code = ppm_read(argv[i], &image);
        if (code == 0) {
            code = print_lamp_candidates(argv[i], &image);
            free(image.plane[0]);
        }
    }
    return code;
}
