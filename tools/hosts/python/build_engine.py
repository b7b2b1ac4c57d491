# SPDX-License-Identifier: MIT
"""The module glint._engine: of the C interface what the package calls, compiled against the
headers, so that layouts are the compiler's."""
import pathlib
import subprocess

import cffi

TREE = pathlib.Path(__file__).resolve().parents[3]
LIBRARIES = ["platform", "bake", "engine", ""]


def archives():
    """Builds glint's archives for shared objects; returns them, and what they are linked with."""
    make = ["make", "-s", "--no-print-directory", "-C", str(TREE), "PIC=yes"]
    *taken, out = subprocess.run(make + ["print-out"], check=True, stdout=subprocess.PIPE, text=True).stdout.split()
    names = [f"{out}/libglint{'-' + name if name else ''}.a" for name in LIBRARIES]
    subprocess.run(make + names, check=True, stdout=subprocess.DEVNULL)
    return [str(TREE / name) for name in names], taken


ffi = cffi.FFI()
ffi.cdef("""
enum glint_status { GLINT_OK, GLINT_E_ARGUMENT, GLINT_E_MEMORY, ... };
struct glint_error { char text[256]; };
const char *glint_status_text(enum glint_status status);

struct glint_prescription { char name[...]; double f_number; _Bool stop_is_circle; int n_mixed; ...; };
struct glint_coating { ...; };
#define GLINT_MAX_COATINGS ...
enum glint_status glint_prescription_parse(struct glint_prescription *lens, const char *text, size_t bytes,
    const char *file_name, struct glint_error *error);
enum glint_status glint_prescription_set_f_number(struct glint_prescription *lens, double f_number, struct glint_error *error);
int glint_coatings_mixed(struct glint_coating *coatings);
int glint_coatings_parse_(struct glint_coating *coatings, int *n, const char *text, struct glint_error *error);
void glint_coat_mixed_(struct glint_prescription *lens);
void glint_coat_(struct glint_prescription *lens, const struct glint_coating *coatings, int n);

typedef void glint_progress_fn(void *ctx, double done);
struct glint_workers { int n; ...; };
enum glint_status glint_pool_create(struct glint_workers **workers, int n_threads);
void glint_pool_destroy(struct glint_workers *workers);
unsigned glint_system_sets(void);

struct glint_bake_options { double max_deg; double tolerance; struct glint_workers *workers; ...; };
struct glint_bake_report { int rays; int intruders; int unmet; };
void glint_bake_defaults(struct glint_bake_options *options);
uint64_t glint_bake_key(const struct glint_prescription *lens, const struct glint_bake_options *options);
enum glint_status glint_bake(const struct glint_prescription *lens, const struct glint_bake_options *options,
    unsigned char **model, size_t *bytes, struct glint_bake_report *report, struct glint_error *error);
void free(void *);

struct glint_model_header { ...; };
struct glint_lens { ...; };
enum glint_status glint_lens_open(struct glint_lens *lens, const void *data, size_t bytes, const char **reason);
double glint_focal_mm_(const struct glint_lens *lens);
void glint_film_mm_(const struct glint_lens *lens, double mm[2]);

enum glint_pixel_format { GLINT_RGB24, GLINT_GREY, GLINT_LINEAR_Q20, GLINT_BGR24, GLINT_XRGB8888, ... };
struct glint_image { enum glint_pixel_format format; int width, height; uint8_t *plane[3]; ptrdiff_t stride_bytes[3]; ...; };
struct glint_lamp { double theta_deg, phi_deg, power; double rgb[3]; double axis[2]; double turn_deg; };
struct glint_projection { double reach; double b[4]; };
struct glint_view { int width, height; double sensor_width_mm; struct glint_projection projection; };
struct glint_view glint_view_fit(int width, int height, double film_width_mm, double film_height_mm);
void glint_view_to_angles(const struct glint_view *view, double focal_mm, double x, double y, struct glint_lamp *lamp);
void glint_view_to_pixel(const struct glint_view *view, double focal_mm, const struct glint_lamp *lamp, double *x, double *y);

struct glint_options { double f_number; const char *coating; int rays; ...; };
void glint_options_defaults(struct glint_options *options);
enum glint_status glint_options_set(struct glint_options *options, const char *name, double value, struct glint_error *error);
enum glint_status glint_options_set_text(struct glint_options *options, const char *name, const char *text, struct glint_error *error);
struct glint_iris { double roundness; ...; };
struct glint_engine_camera { int n_blades; double blade_rotation_deg, sensor_width_mm, sensor_height_mm; struct glint_iris iris; ...; };
struct glint_engine_config { int width, height; const struct glint_lens *model; struct glint_workers *workers; unsigned sets;
    struct glint_engine_camera camera; size_t arena_bytes; int arena_has_all; ...; };
struct glint_engine_lamp { struct glint_lamp lamp; ...; };
struct glint_engine_lamp glint_engine_lamp_of(const struct glint_lamp *lamp, uint32_t id);
void glint_engine_configure(struct glint_engine_config *cfg, const struct glint_options *options);
struct glint_engine_report { int drawn_lights, ghosts; size_t arena_bytes; double scale; ...; };
struct glint_engine;
void glint_engine_defaults(struct glint_engine_config *cfg, int width, int height);
enum glint_status glint_engine_create(struct glint_engine **engine, const struct glint_engine_config *cfg, struct glint_error *error);
void glint_engine_destroy(struct glint_engine *engine);
int glint_engine_find(struct glint_engine *engine, const struct glint_image *image, int32_t elapsed_us, struct glint_engine_lamp *lamps,
    int max);
enum glint_status glint_engine_set(struct glint_engine *engine, const char *name, double value, struct glint_error *error);
void glint_engine_elapsed(struct glint_engine *engine, int32_t elapsed_us);
enum glint_status glint_engine_draw(struct glint_engine *engine, struct glint_engine_lamp *lamps, int n, const struct glint_image *image,
    struct glint_engine_report *report);
""")

objects, taken = archives()
ffi.set_source("glint._engine", r"""
#include <stdlib.h>
#include "glint/glint.h"
#include "glint/options.h"
#include "linux/sets.h"

/* Coats LENS as glint overlay does, with films that differ by surface. */
static void glint_coat_mixed_(struct glint_prescription *lens)
{
    struct glint_coating standard[GLINT_MAX_COATINGS];
    const int n = glint_coatings_mixed(standard);

    if (lens->n_mixed)
        glint_prescription_coat(lens, lens->mixed, lens->n_mixed);
    else
        glint_prescription_coat(lens, standard, n);
}
static int glint_coatings_parse_(struct glint_coating *coatings, int *n, const char *text, struct glint_error *error)
{
    return (int)glint_coatings_parse(coatings, n, text, error);
}
static void glint_coat_(struct glint_prescription *lens, const struct glint_coating *coatings, int n)
{
    glint_prescription_coat(lens, coatings, n);
}
static double glint_focal_mm_(const struct glint_lens *lens)
{
    return glint_real_value(lens->header->focal_mm);
}
static void glint_film_mm_(const struct glint_lens *lens, double mm[2])
{
    mm[0] = glint_real_value(lens->header->film_width_mm);
    mm[1] = glint_real_value(lens->header->film_height_mm);
}
""", include_dirs=[str(TREE / "include"), str(TREE / "platform")],
    extra_objects=objects, depends=objects, extra_compile_args=["-D_POSIX_C_SOURCE=200809L"],
    extra_link_args=taken + ["-Wl,--exclude-libs,ALL"])
