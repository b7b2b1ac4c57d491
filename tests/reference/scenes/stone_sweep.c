/* SPDX-License-Identifier: MIT
 *
 * The dials of translucent things in scene_sweep: of each value stones
 * are baked anew, and pictures are held against all of their rows. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/view.h"
#include "reference/scenes/scene_sweep.h"
#include "stones/stone_file.h"

static const char *const model_name[] = {"none", "albedo", "clustered",
                                         "factored"};
static const enum glint_scatter_model model_of[] = {
    GLINT_SCATTER_ALBEDO, GLINT_SCATTER_ALBEDO, GLINT_SCATTER_CLUSTERED,
    GLINT_SCATTER_FACTORED};

/* Values of each dial by itself, and what is usual of a model; 0 ends them. */
static const struct {
    enum scene_dial dial;
    int value[5];
} alone[] = {{SCENE_PLANES, {2, 3, 8, 10}}, {SCENE_RANK, {1, 2, 3, 4}},
             {SCENE_CODES, {4, 6, 8, 16}},  {SCENE_TAPS, {8, 10, 12, 16}},
             {SCENE_FRAMES, {1, 2, 4}},     {SCENE_MODEL, {1, 2, 3}}};

/* Models and numbers of kernels or terms that meet ranks and frames. */
static const int together[][2] = {{1, 1}, {2, 2}, {2, 4},
                                  {3, 3}, {3, 5}, {3, 10}};
static const int planes_of[] = {0, 1, 4, 5};

/* No fit comes nearer. */
static const int finest[SCENE_DIALS] = {[SCENE_MODEL] = 3,
                                        [SCENE_PLANES] =
                                            GLINT_SCATTER_MAX_TERMS,
                                        [SCENE_RANK] = GLINT_SCATTER_MAX_RANK,
                                        [SCENE_CODES] = 16,
                                        [SCENE_TAPS] = 16};

/* ------------------------------------------------------------------ opening */

static bool are_texts(const struct scene_sweep *s)
{
    for (int i = 0; i < s->stones->n; i++)
        if (!stone_file_is_text(s->stones->path[i]))
            return false;
    return s->stones->n > 0;
}

int stone_sweep_open(struct scene_sweep *s)
{
    static const int plain[] = {4, 4, 1, 8, 2};
    struct glint_translucent stone;
    const char *reason;

    memcpy(s->standard, plain, sizeof plain);
    if (s->text->n_stones == 0)
        return EXIT_OK;
    if (glint_translucent_open(&stone, s->text->stone[0].data,
                               s->text->stone[0].bytes, &reason) != GLINT_OK)
        return tool_fail(s->tool, GLINT_E_LENS, reason);
    s->standard[SCENE_MODEL] =
        stone.header->variant == GLINT_TRANSLUCENT_ALBEDO      ? 1
        : stone.header->variant == GLINT_TRANSLUCENT_CLUSTERED ? 2
                                                               : 3;
    s->standard[SCENE_PLANES] = (int)stone.header->n_planes;
    s->standard[SCENE_RANK] = (int)stone.header->rank;
    s->standard[SCENE_CODES] = (int)stone.header->code_bits;
    s->standard[SCENE_TAPS] = (int)stone.header->tap_bits;
    s->standard[SCENE_TEXELS] = 1 << stone.header->side_log2;
    s->standard[SCENE_FRAMES] = 1;
    return EXIT_OK;
}

/* ------------------------------------------------------------------- points */

/* Adds VALUE unless it is there. */
static void add(struct scene_sweep *s, const int value[SCENE_DIALS])
{
    for (int i = 0; i < s->n_points; i++)
        if (memcmp(s->point[i].value, value, sizeof s->point[i].value) == 0)
            return;
    scene_sweep_add(s, value);
}

static void add_alone(struct scene_sweep *s)
{
    for (size_t i = 0; i < sizeof alone / sizeof *alone; i++)
        for (int k = 0; k < 5 && alone[i].value[k]; k++) {
            int value[SCENE_DIALS];

            memcpy(value, s->standard, sizeof value);
            value[alone[i].dial] = alone[i].value[k];
            if (alone[i].dial == SCENE_MODEL &&
                value[SCENE_MODEL] != s->standard[SCENE_MODEL])
                value[SCENE_PLANES] = planes_of[value[SCENE_MODEL]];
            if (alone[i].dial == SCENE_PLANES && value[SCENE_MODEL] == 1)
                continue;
            add(s, value);
        }
}

void stone_sweep_points(struct scene_sweep *s)
{
    int value[SCENE_DIALS];

    memcpy(value, s->standard, sizeof value);
    if (!are_texts(s)) {
        for (int n = 2; n <= 4 && s->standard[SCENE_FRAMES]; n += 2) {
            value[SCENE_FRAMES] = n;
            add(s, value);
        }
        return;
    }
    add_alone(s);
    for (int by = 2; by <= 4; by *= 2) {
        value[SCENE_TEXELS] = s->standard[SCENE_TEXELS] / by;
        if (value[SCENE_TEXELS] >= 1 << GLINT_TRANSLUCENT_LEAST_LOG2)
            add(s, value);
    }
    value[SCENE_TEXELS] = s->standard[SCENE_TEXELS];
    for (size_t i = 0; i < sizeof together / sizeof *together; i++)
        for (int rank = 2; rank <= 3; rank++)
            for (int frames = 1; frames <= 4; frames *= 2) {
                value[SCENE_MODEL] = together[i][0];
                value[SCENE_PLANES] = together[i][1];
                value[SCENE_RANK] = rank;
                value[SCENE_FRAMES] = frames;
                add(s, value);
            }
}

/* ------------------------------------------------------------------- baking */

/* Makes T what CTX, the values of dials, says; 0 leaves it as it is. */
static void over(void *ctx, struct glint_stone_text *t)
{
    const int *value = ctx;

    t->fit = (struct glint_scatter_options){
        model_of[value[SCENE_MODEL]], value[SCENE_PLANES], value[SCENE_RANK]};
    t->code_bits = value[SCENE_CODES];
    t->tap_bits = value[SCENE_TAPS];
    while (value[SCENE_TEXELS] && t->stone.side > value[SCENE_TEXELS]) {
        t->stone.side /= 2;
        t->stone.texel_mm *= 2;
        t->stone.kernel = t->stone.kernel / 2 | 1;
        if (t->stone.fields > t->stone.side)
            t->stone.fields = t->stone.side;
    }
}

/* Bakes all stones of S->text as VALUE says; TO is theirs to free. */
static int bake_stones(const struct scene_sweep *s, int value[SCENE_DIALS],
                       struct glint_described_stone *to)
{
    struct glint_error error = {""};

    for (int i = 0; i < s->stones->n; i++) {
        struct stone_file file;
        const enum glint_status status = stone_file_read(
            s->tool, s->stones->path[i], over, value, false, &file, &error);

        if (status != GLINT_OK)
            return tool_fail(s->tool, status, error.text);
        to[i] = (struct glint_described_stone){file.data, file.bytes};
    }
    return EXIT_OK;
}

static void free_stones(struct glint_described_stone *stone)
{
    for (int i = 0; i < GLINT_DESCRIPTION_MAX_STONES; i++)
        free(stone[i].data);
}

/* Makes STONE those of the text, and what it had STONE. */
static void exchange(struct scene_sweep *s, struct glint_described_stone *stone)
{
    for (int i = 0; i < s->text->n_stones; i++) {
        const struct glint_described_stone kept = s->text->stone[i];

        s->text->stone[i] = stone[i];
        stone[i] = kept;
    }
}

static int bake_scene(struct scene_sweep *s, struct scene_set *set)
{
    struct glint_described_stone stone[GLINT_DESCRIPTION_MAX_STONES] = {{0}};
    struct glint_error error = {""};
    const char *reason = "";
    unsigned char *data = NULL;
    int code = bake_stones(s, set->value, stone);

    if (code == EXIT_OK) {
        enum glint_status status;

        exchange(s, stone);
        status =
            glint_scene_bake(s->text, s->scene.model.header->name, 0, &data,
                             &set->scene.bytes, &set->scene.report, &error);
        exchange(s, stone);
        set->scene.data = data;
        if (status == GLINT_OK)
            status = glint_scene_open(&set->scene.model, data, set->scene.bytes,
                                      &reason);
        if (status != GLINT_OK)
            code = tool_fail(s->tool, status, *reason ? reason : error.text);
    }
    free_stones(stone);
    return code;
}

static bool is_baked_so(const int *a, const int *b)
{
    return memcmp(a + SCENE_MODEL, b + SCENE_MODEL,
                  (SCENE_TEXELS - SCENE_MODEL + 1) * sizeof *a) == 0;
}

int stone_sweep_bake(struct scene_sweep *s)
{
    int code = EXIT_OK;

    for (int i = 0; i < s->n_points && code == EXIT_OK; i++) {
        struct scene_point *const p = &s->point[i];
        int k = 0;

        if (is_baked_so(p->value, s->standard))
            continue;
        while (k < s->n_sets && !is_baked_so(p->value, s->set[k].value))
            k++;
        if (k == SCENE_SETS)
            return tool_fail(s->tool, GLINT_E_MEMORY, "too many stones");
        if (k == s->n_sets) {
            memcpy(s->set[k].value, p->value, sizeof p->value);
            code = bake_scene(s, &s->set[s->n_sets++]);
        }
        p->scene = &s->set[k].scene;
    }
    return code;
}

/* -------------------------------------------------------------------- exact */

static bool has_balls(const struct scene_sweep *s)
{
    for (int i = 0; i < s->text->n_objects; i++) {
        const struct glint_described_object *o = &s->text->object[i];

        if (o->kind == GLINT_DESCRIBED_SPHERE && o->material >= 0 &&
            s->text->material[o->material].is_stone)
            return true;
    }
    return false;
}

/* How near the stones of S->text are to their rows. */
static int measure_exact(struct scene_sweep *s)
{
    for (int i = 0; i < s->stones->n; i++) {
        struct glint_translucent stone;
        const char *reason;
        double db;

        if (glint_translucent_open(&stone, s->text->stone[i].data,
                                   s->text->stone[i].bytes,
                                   &reason) != GLINT_OK)
            return tool_fail(s->tool, GLINT_E_LENS, reason);
        if (stone_file_near(&s->rows[i], &stone, &db) != GLINT_OK)
            return tool_fail(s->tool, GLINT_E_MEMORY, NULL);
        s->exact_db = i ? fmin(s->exact_db, db) : db;
    }
    return EXIT_OK;
}

int stone_sweep_exact(struct scene_sweep *s, struct glint_described_stone *old)
{
    struct glint_error error = {""};
    int value[SCENE_DIALS], code;

    if (!are_texts(s))
        return EXIT_OK;
    for (int i = 0; i < s->stones->n; i++) {
        const enum glint_status status =
            stone_file_rows(s->tool, s->stones->path[i], &s->rows[i], &error);

        if (status != GLINT_OK)
            return tool_fail(s->tool, status, error.text);
    }
    if (!has_balls(s))
        return EXIT_OK;
    memcpy(value, finest, sizeof value);
    code = bake_stones(s, value, old);
    exchange(s, old);
    return code == EXIT_OK ? measure_exact(s) : code;
}

void stone_sweep_restore(struct scene_sweep *s,
                         struct glint_described_stone *old)
{
    for (int i = 0; i < s->stones->n; i++)
        glint_scatter_close(&s->rows[i]);
    if (old[0].data)
        exchange(s, old);
    free_stones(old);
}

/* ---------------------------------------------------------------------- age */

/* Turns the first thing of stone by DEG about the vertical. */
static void turn(const struct scene_point *p, double deg)
{
    const struct glint_scene_model *model = &p->scene->model;
    const int i = (int)model->skin[0].object;
    const struct glint_scene_object *o = &model->object[i];
    const double half = deg * GLINT_PI / 360, w = cos(half), y = sin(half);
    const int32_t *q = o->turn_q30;
    const double turned[4] = {w * q[0] - y * q[2], w * q[1] + y * q[3],
                              w * q[2] + y * q[0], w * q[3] - y * q[1]};
    int32_t turned_q30[4];

    for (int k = 0; k < 4; k++)
        turned_q30[k] = (int32_t)lrint(turned[k]);
    glint_scene_set_pose(p->trial->frame.scene, i, o->at, turned_q30);
}

void stone_sweep_stir(const struct scene_point *p, int frame)
{
    if (p->value[SCENE_FRAMES])
        turn(p, frame % 2 ? 0 : .1);
}

void stone_sweep_age(const struct scene_point *p)
{
    struct scene_frame *frame = &p->trial->frame;
    const int n = p->value[SCENE_FRAMES];
    bool is_new = n <= 1;

    for (int i = 0; i < 2 * n && !is_new; i++) {
        turn(p, 1 - n - 1e-3 * (2 * n - i));
        scene_frame_begin(frame);
        is_new = glint_scene_spread(frame->scene) > 0;
    }
    for (int i = n - 2; i >= 0; i--) {
        turn(p, -i);
        if (i == 0)
            break;
        scene_frame_begin(frame);
        glint_scene_spread(frame->scene);
    }
    if (n == 1)
        turn(p, 0);
}

/* -------------------------------------------------------------------- words */

const char *stone_sweep_model(const struct scene_point *p)
{
    return model_name[p->value[SCENE_MODEL]];
}

void stone_sweep_words(const struct scene_point *p, char *text, size_t bytes)
{
    const int *v = p->value;

    snprintf(text, bytes, "%s %d, rank %d, bits %d and %d, %d texels, every %d",
             stone_sweep_model(p), v[SCENE_PLANES], v[SCENE_RANK],
             v[SCENE_CODES], v[SCENE_TAPS], v[SCENE_TEXELS], v[SCENE_FRAMES]);
}

void stone_sweep_free(struct scene_sweep *s)
{
    for (int i = 0; i < s->n_sets; i++)
        baked_scene_close(&s->set[i].scene);
    free(s->set);
    free(s->stones);
}
