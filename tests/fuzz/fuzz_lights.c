/* SPDX-License-Identifier: MIT
 *
 * Parses random bytes as a list of lights. Accepted rows must be in the ranges
 * of lamps.h, give finite lamps, and be unchanged after writing and reading
 * them as CSV and as JSON lines.
 *
 *     make fuzz FUZZ=lights SECONDS=60
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fuzz/fuzz.h"
#include "lamp_files/lamp_list.h"

enum { ROWS = 50, ROW_BYTES = 300, FRAMES = 3 };

static void check_lamp_row_values(const struct lamp_row *r)
{
    require(r->frame >= -1 && r->frame < 1000000000);
    require(fabs(r->x) <= 1e6 && fabs(r->y) <= 1e6);
    require(r->power >= 0 && r->power <= 1e30);
    for (int c = 0; c < 3; c++)
        require(r->rgb[c] >= 0 && isfinite(r->power * r->rgb[c]));
    require(r->size >= 0 && isfinite(r->size));
}

static void check_lamp_values(const struct lamp_list *list, int frame)
{
    const struct glint_view view = {
        .width = 640, .height = 360, .sensor_width_mm = 36};
    struct glint_engine_lamp lamp[ROWS];
    const int n = lamp_list_get_frame(list, frame, &view, 50, lamp, ROWS);

    require(n >= 0 && n <= list->n && n <= ROWS);
    for (int i = 0; i < n; i++) {
        require(lamp[i].lamp.theta_deg >= 0 && lamp[i].lamp.theta_deg < 90);
        require(fabs(lamp[i].lamp.phi_deg) <= 360);
    }
}

/* Writes row R to TEXT with 17 digits, which represent every double exactly. */
static int print_lamp_row(char *text, const struct lamp_row *r, int as_json)
{
    const char *const format =
        as_json ? "{\"frame\":%s,\"x\":%.17g,\"y\":%.17g,\"power\":%.17g,"
                  "\"r\":%.17g,\"g\":%.17g,\"b\":%.17g,\"size\":%.17g}\n"
                : "%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n";
    char frame[16] = "*";

    if (r->frame >= 0)
        snprintf(frame, sizeof frame, "%d", r->frame);
    else if (as_json)
        strcpy(frame, "\"*\"");
    return snprintf(text, ROW_BYTES, format, frame, r->x, r->y, r->power,
                    r->rgb[0], r->rgb[1], r->rgb[2], r->size);
}

static void check_lamp_row_round_trip(const struct lamp_list *list, int as_json)
{
    static char text[ROWS * ROW_BYTES];
    struct lamp_list again;
    struct glint_error error;
    size_t bytes = 0;
    int n = 0;

    for (; n < list->n && n < ROWS; n++)
        bytes += (size_t)print_lamp_row(text + bytes, &list->row[n], as_json);
    require(!lamp_list_parse(&again, text, bytes, "again", &error));
    require(again.n == n);
    for (int i = 0; i < n; i++) {
        const struct lamp_row *a = &list->row[i], *b = &again.row[i];

        require(a->frame == b->frame && a->x == b->x && a->y == b->y);
        require(a->power == b->power && a->size == b->size);
        for (int c = 0; c < 3; c++)
            require(a->rgb[c] == b->rgb[c]);
    }
    lamp_list_free(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct lamp_list list;
    struct glint_error error;
    const enum glint_status status =
        lamp_list_parse(&list, (const char *)data, size, "fuzz", &error);

    if (status == GLINT_OK) {
        for (int i = 0; i < list.n; i++)
            check_lamp_row_values(&list.row[i]);
        for (int frame = 0; frame < FRAMES; frame++)
            check_lamp_values(&list, frame);
        check_lamp_row_round_trip(&list, 0);
        check_lamp_row_round_trip(&list, 1);
    } else {
        require(status == GLINT_E_FORMAT && list.n == 0 && !list.row);
        require(!memcmp(error.text, "fuzz:", 5));
    }
    lamp_list_free(&list);
    return 0;
}
