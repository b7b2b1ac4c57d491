/* SPDX-License-Identifier: MIT */
#include "lens_pages/page.h"

#include "model/opened_lens.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/measure.h"
#include "measure/plots/plot.h"
#include "lens_pages/drawing.h"
#include "model/lens_files.h"

enum { LINE_CHARS = 200, PATH_CHARS = 1024 };

/* Copies a cell of a Markdown table to CELL, without the blanks around it. *AT
 * is the position after a '|', and is moved after the next '|'. Returns false
 * if there is no '|' or the cell is too long. */
static bool read_table_cell(const char **at, char *cell, size_t bytes)
{
    const char *from = *at + strspn(*at, " "), *end = strchr(*at, '|');
    size_t n;

    if (!end)
        return false;
    *at = end + 1;
    if (from > end)
        from = end;
    while (end > from && end[-1] == ' ')
        end--;
    n = (size_t)(end - from);
    if (n >= bytes)
        return false;
    memcpy(cell, from, n);
    cell[n] = '\0';
    return true;
}

static bool read_table_row(const char *line, const char *name,
                           struct measured *measured)
{
    char lens[64];

    return *line++ == '|' && read_table_cell(&line, lens, sizeof lens) &&
           strcmp(lens, name) == 0 &&
           read_table_cell(&line, measured->f_number,
                           sizeof measured->f_number) &&
           read_table_cell(&line, measured->seconds,
                           sizeof measured->seconds) &&
           read_table_cell(&line, measured->kb, sizeof measured->kb) &&
           read_table_cell(&line, measured->ms, sizeof measured->ms);
}

enum glint_status page_read_measured_times(const char *name,
                                           struct measured *measured)
{
    static const char file_name[] = "/figures.md";
    char path[PATH_CHARS], line[LINE_CHARS];
    bool found = false, failed = false;

    for (int i = 0;
         !found && !failed &&
         lens_find_folder(i, "lenses", path, sizeof path - sizeof file_name);
         i++) {
        FILE *file = *path ? fopen(strcat(path, file_name), "r") : NULL;

        failed = *path && !file && errno == ENOMEM;
        while (file && !found && fgets(line, sizeof line, file))
            found = read_table_row(line, name, measured);
        failed |= file && !found && ferror(file);
        if (file)
            fclose(file);
    }
    if (!found)
        *measured = (struct measured){.f_number = ""};
    return failed ? GLINT_E_MEMORY : GLINT_OK;
}

enum { ANGLES = 3, WIDE = 168, MOST_HIGH = 168 };

static const double share[ANGLES] = {0.25, 0.5, 0.8};

/* Max ratio of a thumbnail's exposure, that of the ghosts alone, to the
 * automatic exposure of ghosts and starburst. Without this limit the starburst
 * of a lens with faint ghosts would fill the image. */
#define BRIGHTER 40.0

/* Returns the angle, degrees, of a light at the fraction AT of the half
 * diagonal. The projection is that of a pinhole camera (f tan), as in all
 * images. */
static double compute_field_angle_deg(const struct opened_lens *lens, double at)
{
    const double half =
        0.5 * hypot(lens->table.film_width_mm, lens->table.film_height_mm);

    return atan(at * half / lens->setup.optics.focal_mm) * 180 / GLINT_PI;
}

static enum glint_status draw_thumbnail_flare(struct glint_engine *engine,
                                              double theta_deg,
                                              struct glint_float_image *image,
                                              float *star, FILE *file)
{
    const struct glint_lamp lamp = {
        .theta_deg = theta_deg, .phi_deg = 33, .power = 1, .rgb = {1, 1, 1}};
    const size_t n = 3 * (size_t)image->width * (size_t)image->height;
    struct glint_engine_report report;
    uint8_t *codes;
    double exposure;
    enum glint_status status = glint_engine_render(
        engine, &lamp, 1, 1, GLINT_ENGINE_GHOSTS, image->rgb, &report);

    if (status == GLINT_OK)
        status = glint_engine_render(engine, &lamp, 1, 1, GLINT_ENGINE_STAR,
                                     star, &report);
    if (status != GLINT_OK)
        return status;
    exposure = glint_measure_exposure(image);
    for (size_t i = 0; i < n; i++)
        image->rgb[i] += star[i];
    codes = glint_measure_encode(
        image, fmin(exposure, BRIGHTER * glint_measure_exposure(image)));
    if (!codes)
        return GLINT_E_MEMORY;
    fprintf(file,
            "<img alt=\"lamp at %.1f degrees\" title=\"lamp at %.1f degrees\" "
            "src=\"",
            theta_deg, theta_deg);
    html_write_png(file, codes, image->width, image->height);
    fputs("\">", file);
    free(codes);
    return GLINT_OK;
}

static int draw_lens_thumbnails(const struct tool *tool,
                                const struct opened_lens *lens,
                                const struct settings *s, FILE *file)
{
    const double tall =
        ceil(WIDE * lens->table.film_height_mm / lens->table.film_width_mm);
    struct glint_float_image image = {
        .width = WIDE, .height = (int)fmin(fmax(tall, 8), MOST_HIGH)};
    const size_t n = 3 * (size_t)image.width * (size_t)image.height;
    enum glint_status status = GLINT_E_MEMORY;
    struct glint_engine_config cfg;
    struct glint_engine *engine = NULL;
    struct glint_error error = {""};
    float *star = calloc(n, sizeof *star);

    image.rgb = calloc(n, sizeof *image.rgb);
    opened_lens_configure_engine(tool, lens, s, image.width, image.height,
                                 &cfg);
    cfg.light.by_hand = 1;
    cfg.light.starburst = 1;
    cfg.search.max_found = 0;
    cfg.drawing.is_fresh = 1;
    if (image.rgb && star)
        status = glint_engine_create(&engine, &cfg, &error);
    for (int i = 0; i < ANGLES && status == GLINT_OK; i++)
        status = draw_thumbnail_flare(engine,
                                      compute_field_angle_deg(lens, share[i]),
                                      &image, star, file);
    glint_engine_destroy(engine);
    free(star);
    free(image.rgb);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

int page_write_thumbnails(const struct tool *tool,
                          const struct settings *settings, const char *name,
                          FILE *file, size_t *model_bytes)
{
    struct opened_lens *const lens = calloc(1, sizeof *lens);
    int code;

    *model_bytes = 0;
    if (!lens)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    code = opened_lens_open(tool, lens, settings, name);
    *model_bytes = lens->model.bytes;
    if (code == EXIT_OK)
        code = draw_lens_thumbnails(tool, lens, settings, file);
    opened_lens_close(lens);
    free(lens);
    return code;
}

/* width of the drawn section, SVG units; the page scales it to the card */
#define SECTION_PX 560

static const char style[] =
    "body{margin:0 auto;padding:1.5em;max-width:1600px;background:#f3f3f1}"
    "h1{margin:0;font-size:1.6em}h2{margin:0;font-size:1.1em}p{margin:.3em 0}"
    "main{display:grid;grid-template-columns:"
    "repeat(auto-fill,minmax(min(100%,430px),1fr));gap:1em;"
    "align-items:start;margin-top:1em}"
    "figure{margin:0;padding:.8em 1em;background:#fff;border:1px solid #ddd;"
    "font-size:1em;display:block}"
    "svg{display:block;width:100%;max-height:21em;margin:.4em 0}"
    "img{display:inline;width:32%;margin-right:1%}"
    "input,select{font:inherit;padding:.2em .4em}input{width:20em}"
    ".less{color:#666;font-size:.87em}";

static const char head[] =
    "<header><p>Sections show rays of three points of the picture: its centre "
    "(blue), 0.7 of the way to the corner (green) and nearly the corner (red). "
    "Flares show a lamp at a quarter, half and four fifths of the way to the "
    "corner. <code>glint overlay photo.jpg -o out.jpg --lens NAME</code> draws "
    "the flare of a lens.</p>\n"
    "<p hidden id=\"tools\"><input id=\"find\" type=\"search\" "
    "placeholder=\"words: zoom, zeiss, 1935, streak\"> <select "
    "id=\"by\"><option value=\"\">by name<option value=\"focal\">by focal "
    "length<option value=\"angle\">by angle<option value=\"f\">by "
    "f-number<option value=\"ghosts\">by ghosts</select> <output "
    "id=\"n\"></output></p></header>\n"
    "<main>\n";

/* Script of the page. The search matches the text of a card except the glass
 * names in its section. */
static const char script[] =
    "<script>\n"
    "const at=id=>document.getElementById(id),main=document.querySelector("
    "'main'),all=[...main.children];\n"
    "function show(){const words=at('find').value.toLowerCase().split(/\\s+/);"
    "let n=0;for(const c of all){const "
    "text=[...c.querySelectorAll('h2,p')].map("
    "p=>p.textContent).join(' ').toLowerCase();"
    "c.hidden=!words.every(w=>text.includes(w));n+=!c.hidden}"
    "at('n').textContent=n+' of '+all.length}\n"
    "at('find').oninput=show;at('by').onchange=()=>{const by=at('by').value;"
    "main.append(...(by?[...all].sort((a,b)=>a.dataset[by]-b.dataset[by]):all"
    "))};\n"
    "at('tools').hidden=false;show();\n"
    "</script>\n";

void page_write_head(FILE *file)
{
    html_write_head(file, "Lenses", style);
    fputs(head, file);
}

/* Writes the lens data that photographers use to choose a lens. */
static void print_lens_numbers(FILE *file, const struct page_card *card)
{
    const struct glint_prescription *lens = card->lens;

    fprintf(file, "<p>%.4g mm", card->focal_mm);
    if (fabs(card->squeeze - 1) > 1e-6)
        fprintf(file, " up and down, %.4g across",
                card->focal_mm / card->squeeze);
    fprintf(file, ", f/%.3g, ", lens->f_number);
    if (card->corner_deg < 89.5)
        fprintf(file, "%.0f&deg; from corner to corner", 2 * card->corner_deg);
    else
        fputs("180&deg; or more", file);
    fprintf(file, " of %.4g x %.4g mm, %d ghosts</p>\n", lens->film_width_mm,
            lens->film_height_mm, card->n_ghosts);
}

void page_begin_card(FILE *file, const struct page_card *card)
{
    struct lens_drawing drawing;

    fprintf(file,
            "<figure id=\"%s\" data-focal=\"%.6g\" data-angle=\"%.4g\" "
            "data-f=\"%g\" data-ghosts=\"%d\"><h2>%s</h2>\n<p>",
            card->name, card->focal_mm, card->corner_deg, card->lens->f_number,
            card->n_ghosts, card->name);
    html_write_text(file, card->lens->source);
    fputs("</p>\n", file);
    if (*card->lens->character) {
        fputs("<p>", file);
        html_write_text(file, card->lens->character);
        fputs("</p>\n", file);
    }
    print_lens_numbers(file, card);
    lens_drawing_set_defaults(&drawing, card->lens);
    drawing.spots = drawing.title = false;
    drawing.width_px = SECTION_PX;
    lens_drawing_write(&drawing, file);
}

void page_end_card(FILE *file)
{
    fputs("</figure>\n", file);
}

void page_write_end(FILE *file)
{
    fprintf(file, "</main>\n%s", script);
    html_write_end(file);
}
