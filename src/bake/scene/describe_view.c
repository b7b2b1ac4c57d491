/* SPDX-License-Identifier: MIT
 *
 * Parses the lines "hand", "camera", "background", "shadow" and "flare".
 */
#include "bake/scene/describe.h"

#include <math.h>
#include <string.h>

#include "glint/view.h"

#define REACH     GLINT_DESCRIPTION_REACH
#define MAX_LIGHT 32768.0 /* max radiance of the background colour */
/* Min sine of the angle between viewing direction and up vector; at smaller
 * angles the right vector is undefined. */
#define LEAST_RIGHT 1e-6

static double compute_dot_product(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void compute_cross_product(const double a[3], const double b[3],
                                  double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* Parses one word and sets INDEX to its index in WORDS. LIST describes the
 * words in the error text about LINE. */
static bool read_listed_word(struct glint_describer *d, const char *line,
                             const char *list, const char *const *words,
                             int *index)
{
    const struct glint_word word = glint_text_next_word(&d->text);
    char quote[GLINT_QUOTE_BYTES];

    for (*index = 0; words[*index]; ++*index)
        if (glint_word_equals(&word, words[*index]))
            return true;
    if (!word.length)
        return glint_text_set_error(&d->text, word.place, "%s needs %s", line,
                                    list);
    glint_word_quote(&word, quote);
    return glint_text_set_error(&d->text, word.place, "%s accepts %s, not '%s'",
                                line, list, quote);
}

bool glint_describe_parse_hand(struct glint_describer *d)
{
    static const char *const words[] = {"right", "left", NULL};
    int index;

    if (!read_listed_word(d, "hand", "right or left", words, &index))
        return false;
    d->scene->left_handed = index == 1;
    return glint_line_check_end(&d->text, "hand");
}

bool glint_describe_parse_background(struct glint_describer *d)
{
    static const char *const words[] = {"camera", "colour", "environment",
                                        NULL};
    struct glint_text at = d->text;
    int index;

    d->background = glint_text_next_word(&at).place;
    if (!read_listed_word(d, "background",
                          "camera, colour R G B or environment", words, &index))
        return false;
    d->scene->background = (enum glint_described_background)index;
    return (index != GLINT_BEHIND_COLOUR ||
            glint_numbers_read(&d->text, "colour", 3, 0, MAX_LIGHT,
                               d->scene->background_colour)) &&
           glint_line_check_end(&d->text, "background");
}

bool glint_describe_parse_shadow(struct glint_describer *d)
{
    static const char *const words[] = {"off", "on", NULL};
    int index;

    if (!read_listed_word(d, "shadow", "on or off", words, &index))
        return false;
    d->scene->has_shadows = index == 1;
    return glint_line_check_end(&d->text, "shadow");
}

bool glint_describe_parse_flare(struct glint_describer *d)
{
    static const char *const words[] = {"off", "lights", NULL};
    struct glint_description *s = d->scene;
    double n = 0;
    struct glint_clause clause[] = {{"highlights", 1, 0, 8, .value = &n}, {0}};
    int index;

    if (!read_listed_word(d, "flare", "off or lights [highlights N]", words,
                          &index))
        return false;
    if (index == 0)
        return glint_line_check_end(&d->text, "flare off");
    if (!glint_clauses_read(&d->text, "flare lights", clause))
        return false;
    s->n_highlights = (int)n;
    s->flare = s->n_highlights ? GLINT_DESCRIBED_FLARE_HIGHLIGHTS
                               : GLINT_DESCRIBED_FLARE_LIGHTS;
    return n == s->n_highlights ||
           glint_text_set_error(&d->text, clause[0].place,
                                "'highlights' must be a whole number, 0 to 8");
}

/* Parses the first words of the line "camera", which define the field of view.
 * Sets ALL to true if they must be the line's only words. Returns false on
 * errors. */
static bool read_field_of_view(struct glint_describer *d, bool *all)
{
    struct glint_described_camera *c = &d->scene->camera;
    struct glint_text at = d->text;
    const struct glint_word word = glint_text_next_word(&d->text);

    *all = false;
    if (glint_word_equals(&word, "corners")) {
        c->field = GLINT_DESCRIBED_CORNERS;
        *all = true;
        return glint_line_check_end(&d->text, "camera corners");
    }
    if (glint_word_equals(&word, "sensor")) {
        double k;

        d->sensor = word.place;
        *all = true;
        if (!glint_numbers_read(&d->text, "sensor", 1, 1, 32, &k))
            return false;
        d->scene->motion.camera = (int)k - 1;
        return glint_line_check_end(&d->text, "camera sensor");
    }
    if (glint_word_equals(&word, "lens")) {
        c->field = GLINT_DESCRIBED_LENS;
        return true;
    }
    if (glint_word_equals(&word, "fov"))
        return glint_numbers_read(&d->text, "fov", 1, 0.1, 170, &c->fov_deg);
    d->text = at;
    return true;
}

bool glint_describe_parse_camera(struct glint_describer *d)
{
    struct glint_described_camera *c = &d->scene->camera;
    struct glint_clause clause[] = {
        {"at", 3, -REACH, REACH, .value = c->at},
        {"toward", 3, -REACH, REACH, .value = d->toward},
        {"up", 3, -REACH, REACH, .value = d->up},
        {"orbit", 3, -REACH, REACH, .value = d->orbit},
        {"distance", 1, GLINT_DESCRIPTION_LEAST, REACH, .value = &d->distance},
        {"yaw", 1, -1e4, 1e4, .value = &d->yaw_deg},
        {"pitch", 1, -89.9, 89.9, .value = &d->pitch_deg},
        {0}};
    struct glint_text at = d->text;
    bool all;

    d->camera = glint_text_next_word(&at).place;
    if (!read_field_of_view(d, &all))
        return false;
    if (all)
        return true;
    if (!glint_clauses_read(&d->text, "camera", clause))
        return false;
    d->has_orbit = clause[3].place.line > 0;
    if (d->has_orbit) {
        for (int i = 0; i < 3; i++)
            if (clause[i].place.line)
                return glint_text_set_error(
                    &d->text, clause[i].place,
                    "'%s' and 'orbit' cannot be combined", clause[i].word);
        return clause[4].place.line ||
               glint_text_set_error(&d->text, clause[3].place,
                                    "an orbit needs 'distance'");
    }
    for (int i = 4; i < 7; i++)
        if (clause[i].place.line)
            return glint_text_set_error(&d->text, clause[i].place,
                                        "'%s' may only be used with 'orbit'",
                                        clause[i].word);
    return (clause[0].place.line && clause[1].place.line) ||
           glint_text_set_error(
               &d->text, d->camera,
               "camera needs 'at X Y Z toward X Y Z', or 'orbit'");
}

static void set_orbit_camera(struct glint_describer *d)
{
    struct glint_described_camera *c = &d->scene->camera;
    const double yaw = d->yaw_deg * GLINT_PI / 180;
    const double pitch = d->pitch_deg * GLINT_PI / 180;
    /* With yaw 0 the camera looks into the picture: along +z in left-handed
     * scenes, -z in right-handed ones. */
    const double from[3] = {cos(pitch) * sin(yaw), sin(pitch),
                            (d->scene->left_handed ? -1 : 1) * cos(pitch) *
                                cos(yaw)};

    for (int i = 0; i < 3; i++) {
        c->at[i] = d->orbit[i] + d->distance * from[i];
        c->forward[i] = -from[i];
    }
}

bool glint_describe_set_camera_axes(struct glint_describer *d)
{
    struct glint_described_camera *c = &d->scene->camera;
    const double hand = d->scene->left_handed ? 1 : -1;

    if (c->field == GLINT_DESCRIBED_CORNERS || !d->camera.line ||
        d->sensor.line) {
        /* By default a camera looks into the picture, but "camera corners"
         * always looks along +z. */
        c->forward[2] = c->field == GLINT_DESCRIBED_CORNERS ? 1 : hand;
    } else if (d->has_orbit) {
        set_orbit_camera(d);
    } else {
        for (int i = 0; i < 3; i++)
            c->forward[i] = d->toward[i] - c->at[i];
    }
    if (!glint_describe_normalise_vector(c->forward))
        return glint_text_set_error(
            &d->text, d->camera,
            "the camera's position equals the point that it looks at");
    if (!glint_describe_normalise_vector(d->up))
        return glint_text_set_error(&d->text, d->camera,
                                    "'up' must not be 0 0 0");
    compute_cross_product(c->forward, d->up, c->right);
    if (!(compute_dot_product(c->right, c->right) > LEAST_RIGHT * LEAST_RIGHT))
        return glint_text_set_error(
            &d->text, d->camera, "the camera's direction is parallel to 'up'");
    glint_describe_normalise_vector(c->right);
    compute_cross_product(c->right, c->forward, c->up);
    glint_describe_normalise_vector(c->up);
    if (d->scene->left_handed)
        for (int i = 0; i < 3; i++)
            c->right[i] = -c->right[i];
    return true;
}
