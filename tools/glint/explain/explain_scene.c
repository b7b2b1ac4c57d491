/* SPDX-License-Identifier: MIT */
#include "explain/explain_scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "explain/explain.h"

static const struct {
    const char *word, *reason;
} fates[GLINT_SCENE_FATES] = {
    [GLINT_SCENE_DRAWN] = {"drawn", "drawn"},
    [GLINT_SCENE_OFF] = {"off", "not shown"},
    [GLINT_SCENE_BEHIND] = {"behind", "behind the camera"},
    [GLINT_SCENE_OUTSIDE] = {"outside", "outside the picture"},
    [GLINT_SCENE_COVERED] = {"covered", "behind"},
    [GLINT_SCENE_SMALL] = {"small", "below a pixel"},
};

static const struct glint_scene_model *
get_model(const struct explained_scene *s)
{
    return &s->drawing->files.scene.baked.model;
}

static const char *get_object_name(const struct explained_scene *s, int object)
{
    const char *const name =
        object >= 0 ? get_model(s)->object[object].name : "background";

    return *name ? name : "(no name)";
}

enum glint_status explained_scene_open(struct explained_scene *scene,
                                       const struct drawing *drawing,
                                       const struct glint_explain *flare)
{
    *scene = (struct explained_scene){.drawing = drawing, .flare = flare};
    return scene_account_collect_costs(&scene->account,
                                       &drawing->files.scene.frame);
}

void explained_scene_close(struct explained_scene *scene)
{
    scene_account_free(&scene->account);
}

/* ------------------------------------------------------------------- lights */

/* State of a scene light in the picture */
struct light {
    const char *word;  /* drawn, hidden, behind, outside ... */
    const char *extra; /* name of the object that hides the light; NULL: none */
    double x, y;  /* position, pixels; undefined for lights behind the camera */
    double share; /* visible fraction of the light */
    bool is_ahead;
};

/* Returns the index of the flare's light that is nearest to LAMP, at most
 * LAMP's extent plus a pixel away, or -1 if there is none. */
static int find_flare_light_of_lamp(const struct explained_scene *s,
                                    const struct glint_lamp *lamp)
{
    const double focal = s->drawing->files.lens.setup.optics.focal_mm;
    const double px = glint_view_pixel_tangent(&s->drawing->run.view, focal);
    double best = px + 2 * lamp->axis[0];
    int found = -1;

    for (int i = 0; i < s->flare->n_lights; i++) {
        const struct glint_light *const l = &s->flare->lights[i];
        const double t = tan(lamp->theta_deg * GLINT_PI / 180);
        const double u =
            l->cosine_q30 > 0 ? (double)l->sine_q30 / l->cosine_q30 : HUGE_VAL;
        const double phi = lamp->phi_deg * GLINT_PI / 180;
        const double away = hypot(t * cos(phi) - u * l->cos_q30 * 0x1p-30,
                                  t * sin(phi) - u * l->sin_q30 * 0x1p-30);

        if (away <= best) {
            best = away;
            found = i;
        }
    }
    return found;
}

/* Returns a word for the result of LAMP in the flare: drawn, merged, too faint
 * ... */
static const char *describe_lamp_outcome(const struct explained_scene *s,
                                         const struct glint_lamp *lamp)
{
    const struct glint_explain_part *part;
    int at, most = GLINT_OUTCOME_EMPTY;

    if (!s->flare)
        return "no lens";
    if (!(lamp->power > 0))
        return "no power";
    if (glint_explain_is_beyond(s->flare, lamp))
        return "outside the model";
    at = find_flare_light_of_lamp(s, lamp);
    if (at < 0)
        return "merged";
    part = &s->flare->light[at];
    if (glint_explain_drawn(part) > 0)
        return part->lit > 0 ? "drawn" : "too faint for the lens";
    for (int k = GLINT_OUTCOME_EMPTY; k < GLINT_OUTCOMES; k++)
        if (part->of[k] > part->of[most])
            most = k;
    return most == GLINT_OUTCOME_FAINT
               ? "too faint for the lens"
               : explain_outcome_reason((enum glint_outcome)most);
}

/* Returns the state of scene light I. SEEN[N] are the lights in front of the
 * camera. The lights in SEEN whose intensity is not 0 are, in this order, the
 * lamps that the scene adds to the flare. */
static struct light find_light_outcome(const struct explained_scene *s, int i,
                                       const struct glint_scene_lamp *seen,
                                       int n)
{
    const struct drawing *const c = s->drawing;
    struct light light = {.word = "behind the camera"};
    const struct glint_engine_lamp *lamp = c->run.lamp + c->run.n_own;

    if (!get_model(s)->header->flare) {
        light.word = "lights objects only (add 'flare lights' to the scene)";
        return light;
    }
    for (int k = 0; k < n; k++) {
        const bool has_light = seen[k].rgb[0].mantissa ||
                               seen[k].rgb[1].mantissa ||
                               seen[k].rgb[2].mantissa;

        if (seen[k].light == i) {
            light = (struct light){.word = "no light",
                                   .x = seen[k].x_q8 / 256.0,
                                   .y = seen[k].y_q8 / 256.0,
                                   .share = seen[k].share / 16.0,
                                   .is_ahead = true};
            if (seen[k].share == 0) {
                light.word = "hidden by";
                light.extra = get_object_name(
                    s, glint_scene_hider(c->files.scene.frame.scene, i));
            } else if (has_light)
                light.word = c->files.has_lens
                                 ? describe_lamp_outcome(s, &lamp->lamp)
                                 : "no lens";
            return light;
        }
        lamp += has_light;
    }
    return light;
}

static bool has_light_power(const struct glint_scene_light *light)
{
    return light->rgb[0].mantissa || light->rgb[1].mantissa ||
           light->rgb[2].mantissa;
}

static int list_scene_lights(const struct explained_scene *s,
                             struct light *light)
{
    struct glint_scene_lamp seen[GLINT_SCENE_MAX_LIGHTS];
    const int n = glint_scene_lights(s->drawing->files.scene.frame.scene, seen);
    const struct glint_scene_header *const h = get_model(s)->header;
    const int own = (int)(h->n_lights - h->n_environment_lights);
    int all = (int)h->n_lights;

    while (all > own && !has_light_power(&get_model(s)->light[all - 1]))
        /* skips unused entries, reserved for an environment with more lights */
        all--;
    for (int i = 0; i < all; i++)
        light[i] = find_light_outcome(s, i, seen, n);
    return all;
}

static const char *write_light_name(const struct explained_scene *s, int i,
                                    char text[40])
{
    const char *const name = get_model(s)->light[i].name;

    if (*name)
        snprintf(text, 40, "%.39s", name);
    else
        snprintf(text, 40, "%d", i);
    return text;
}

/* --------------------------------------------------------------- highlights */

/* State of a highlight in the flare */
struct highlight {
    const char *word; /* drawn, merged, too faint ... */
    double x, y, power;
    /* object with the highlight, and number of ray bundles drawn for the
     * highlight */
    int object, bundles;
};

/* Sets FOUND[GLINT_SCENE_MAX_HIGHLIGHTS] to the highlights, which are the last
 * lamps of the drawing, in order. Returns their number. */
static int list_highlights(const struct explained_scene *s,
                           struct highlight *found)
{
    const struct drawing *const c = s->drawing;
    struct glint_scene_highlight seen[GLINT_SCENE_MAX_HIGHLIGHTS];
    const int n = glint_scene_find_highlights(c->files.scene.frame.scene, seen);

    for (int i = 0; i < n; i++) {
        const struct glint_spot *const spot = &seen[i].spot;
        const struct glint_lamp *const lamp =
            c->files.has_lens ? &c->run.lamp[c->run.n_lamps - n + i].lamp
                              : NULL;
        const int at =
            lamp && s->flare ? find_flare_light_of_lamp(s, lamp) : -1;

        found[i] = (struct highlight){
            lamp ? describe_lamp_outcome(s, lamp) : "no lens",
            spot->x_q8 / 256.0,
            spot->y_q8 / 256.0,
            (double)spot->power_q16 * 0x1p-16,
            seen[i].object,
            at < 0 ? 0 : glint_explain_drawn(&s->flare->light[at])};
    }
    return n;
}

/* -------------------------------------------------------------------- table */

static int count_objects(const struct explained_scene *s,
                         enum glint_scene_fate fate)
{
    int n = 0;

    for (uint32_t i = 0; i < get_model(s)->header->n_objects; i++)
        n += s->account.objects[i].fate == fate;
    return n;
}

static void print_scene_title(const struct explained_scene *s)
{
    const struct glint_scene_header *const h = get_model(s)->header;

    printf("scene %s, %dx%d: %u objects, drawn %d", h->name,
           s->drawing->files.scene.frame.cfg.width,
           s->drawing->files.scene.frame.cfg.height, h->n_objects,
           count_objects(s, GLINT_SCENE_DRAWN));
    for (int k = GLINT_SCENE_OFF; k < GLINT_SCENE_FATES; k++)
        if (count_objects(s, (enum glint_scene_fate)k))
            printf(", %s %d", fates[k].word,
                   count_objects(s, (enum glint_scene_fate)k));
    printf("\n");
}

static void print_scene_lights(const struct explained_scene *s)
{
    struct light light[GLINT_SCENE_MAX_LIGHTS];
    const int n = list_scene_lights(s, light);
    char name[40];

    printf("\n%-22s %9s %9s %7s  %s\n", "light", "x", "y", "visible", "");
    for (int i = 0; i < n; i++) {
        printf("%-22s ", write_light_name(s, i, name));
        if (light[i].is_ahead)
            printf("%9.1f %9.1f %6.0f%%", light[i].x, light[i].y,
                   100 * light[i].share);
        else
            printf("%9s %9s %7s", "", "", "");
        printf("  %s%s%s\n", light[i].word, light[i].extra ? " " : "",
               light[i].extra ? light[i].extra : "");
    }
}

static void print_scene_highlights(const struct explained_scene *s)
{
    struct highlight found[GLINT_SCENE_MAX_HIGHLIGHTS];
    const int n = list_highlights(s, found);

    if (n > 0)
        printf("\n%-22s %9s %9s %9s %7s\n", "highlight on", "x", "y", "power",
               "bundles");
    for (int i = 0; i < n; i++)
        printf("%-22s %9.1f %9.1f %9.4g %7d  %s\n",
               get_object_name(s, found[i].object), found[i].x, found[i].y,
               found[i].power, found[i].bundles, found[i].word);
}

/* Layers drawn over the objects of a recorded motion */
static const struct {
    enum glint_scene_kind kind;
    const char *word;
} layers[] = {{GLINT_KIND_SHELLS, "shells"},
              {GLINT_KIND_LINES, "lines"},
              {GLINT_KIND_BOX, "box"}};

enum { N_LAYERS = sizeof layers / sizeof *layers };

static void print_scene_layers(const struct explained_scene *s)
{
    if (!get_model(s)->motion)
        return;
    printf("\n%-26s %8s %8s\n", "over the motion's objects", "pixels",
           "number");
    for (int i = 0; i < N_LAYERS; i++) {
        const struct glint_scene_layered *const l =
            &s->account.layer[layers[i].kind];

        printf("    %-22s %8" PRId64 " %8d\n", layers[i].word, l->pixels, l->n);
    }
}

/* Prints the number of light-map texels of translucent media. */
static void print_light_maps(const struct explained_scene *s)
{
    if (get_model(s)->header->n_skins > 0)
        printf("\nmaps of translucent media: light has spread to %d texels\n",
               s->drawing->files.scene.frame.map_texels);
}

void explain_scene_print_tables(const struct explained_scene *s)
{
    print_scene_title(s);
    printf("\n%3s %-22s %8s %8s %9s %8s %8s %7s %9s\n", "", "object", "pixels",
           "shaded", "shadows", "texels", "lookups", "bounced", "triangles");
    for (uint32_t i = 0; i < get_model(s)->header->n_objects; i++) {
        const struct glint_scene_part *const p = &s->account.objects[i];
        const int64_t *const n = p->count;

        printf("%3u %-22s ", i, get_object_name(s, (int)i));
        if (p->fate == GLINT_SCENE_DRAWN)
            printf("%8" PRId64 " %8" PRId64 " %9" PRId64 " %8" PRId64
                   " %8" PRId64 " %7" PRId64 " %9" PRId64,
                   n[GLINT_SCENE_COVERING], n[GLINT_SCENE_SHADED],
                   n[GLINT_SCENE_SHADOWS], n[GLINT_SCENE_TEXELS],
                   n[GLINT_SCENE_LOOKUPS], n[GLINT_SCENE_BOUNCED],
                   n[GLINT_SCENE_TRIANGLES]);
        else
            printf("%s%s%s", fates[p->fate].reason,
                   p->fate == GLINT_SCENE_COVERED ? " " : "",
                   p->fate == GLINT_SCENE_COVERED ? get_object_name(s, p->by)
                                                  : "");
        printf("\n");
    }
    print_scene_layers(s);
    print_light_maps(s);
    print_scene_lights(s);
    print_scene_highlights(s);
}

/* --------------------------------------------------------------------- JSON */

static void write_highlights_json(struct json_writer *json,
                                  const struct explained_scene *s)
{
    struct highlight found[GLINT_SCENE_MAX_HIGHLIGHTS];
    const int n = list_highlights(s, found);

    json_write(json, "highlights: [");
    for (int i = 0; i < n; i++)
        json_write(json,
                   "{object: %s, x: %.2f, y: %.2f, power: %.6g, bundles: %d, "
                   "fate: %s}",
                   get_object_name(s, found[i].object), found[i].x, found[i].y,
                   found[i].power, found[i].bundles, found[i].word);
    json_write(json, "]");
}

static void write_lights_json(struct json_writer *json,
                              const struct explained_scene *s)
{
    struct light light[GLINT_SCENE_MAX_LIGHTS];
    const int n = list_scene_lights(s, light);
    char name[40];

    json_write(json, "lights: [");
    for (int i = 0; i < n; i++) {
        json_write(json, "{name: %s", write_light_name(s, i, name));
        if (light[i].is_ahead)
            json_write(json, "x: %.2f, y: %.2f, seen: %.4f", light[i].x,
                       light[i].y, light[i].share);
        json_write(json, "fate: %s, by: %s}", light[i].word, light[i].extra);
    }
    json_write(json, "]");
}

void explain_scene_write_json(struct json_writer *json,
                              const struct explained_scene *s)
{
    json_write(json, "{objects: [");
    for (uint32_t i = 0; i < get_model(s)->header->n_objects; i++) {
        const struct glint_scene_part *const p = &s->account.objects[i];
        const bool is_covered = p->fate == GLINT_SCENE_COVERED && p->by >= 0;

        json_write(json, "{name: %s, fate: %s, by: %s",
                   get_model(s)->object[i].name, fates[p->fate].word,
                   is_covered ? get_object_name(s, p->by) : NULL);
        for (int k = 0; k < GLINT_SCENE_ITEMS; k++)
            json_write(json, "%s: %" PRId64, scene_item_name[k], p->count[k]);
        json_write(json, "}");
    }
    json_write(json, "], layers: {");
    for (int k = 0; k < N_LAYERS; k++)
        json_write(json, "%s: {number: %d, pixels: %" PRId64 "}",
                   layers[k].word, s->account.layer[layers[k].kind].n,
                   s->account.layer[layers[k].kind].pixels);
    json_write(json, "}");
    write_lights_json(json, s);
    write_highlights_json(json, s);
    json_write(json, "}");
}
