/* SPDX-License-Identifier: MIT
 *
 * Caches lens responses in files, so that later runs need not measure them
 * again.
 *
 * The key of an entry is a hash of the model, of all settings that affect
 * brightness, and of the library's version. An entry has about 800 bytes.
 * Responses whose entries are damaged or of another format are measured and
 * stored again. */
#include <math.h>
#include <string.h>

#include "engine/response.h"
#include "glint/glint.h"

/* Part of the cache key. It must be increased when glint_response_measure()
 * returns other values for the same lens, because frames are drawn or measured
 * differently. */
enum { REVISION = 2 };

enum { VALUES = 7 * GLINT_RESPONSE_ANGLES + 2 * GLINT_RESPONSE_EXTENTS };

/* A cache entry, in native byte order, without padding. */
struct entry {
    char magic[8];
    uint64_t key;
    int32_t n;
    uint32_t crc32; /* checksum of the member value */
    double value[VALUES];
};

static const char magic[8] = "glintRS";

/* ---------------------------------------------------------------------- key */

/* Adds the bytes of WORD to the hash KEY (FNV-1a), the lowest byte first. */
static void add_word_to_hash(uint64_t *key, uint64_t word)
{
    for (int shift = 0; shift < 64; shift += 8)
        *key = (*key ^ (word >> shift & 255)) * UINT64_C(0x100000001b3);
}

static void add_values_to_hash(uint64_t *key, const double *value, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        uint64_t word;

        memcpy(&word, &value[i], sizeof word);
        add_word_to_hash(key, word);
    }
}

/* Adds the stop and the wavelengths of setup S to the hash KEY. All other
 * members of the setup follow from the model, which the key includes. */
static void add_setup_to_hash(uint64_t *key, const struct glint_setup *s)
{
    const size_t n = (size_t)s->n_wavelengths;
    const double stop[] = {s->n_blades, s->blade_rotation_deg, s->opening,
                           s->n_wavelengths, s->n_sets};
    const struct glint_iris *own = &s->iris;
    const double iris[] = {own->roundness, own->softness, own->dust,
                           own->dust_seed, s->clear};
    const struct glint_set_wave *w = s->set_wave;

    add_values_to_hash(key, stop, sizeof stop / sizeof *stop);
    if (own->roundness > 0 || s->dirt)
        add_values_to_hash(key, iris, sizeof iris / sizeof *iris);
    add_values_to_hash(key, s->wavelength_nm, n);
    add_values_to_hash(key, s->rgb[0], 3 * n);
    add_values_to_hash(key, s->unit_flux, n);
    for (int i = 0; i < s->n_sets; i++) {
        const double size = s->set_size[i];

        add_values_to_hash(key, &size, 1);
        for (int j = 0; j < s->set_size[i]; j++, w++) {
            add_values_to_hash(key, &w->nm, 1);
            add_values_to_hash(key, w->rgb, 3);
            add_values_to_hash(key, &w->unit_flux, 1);
        }
    }
}

/* Adds to the hash KEY the quality parameters that affect brightness, except
 * those that glint_response_measure() sets itself. */
static void add_quality_parameters_to_hash(uint64_t *key,
                                           const struct glint_frame *like)
{
    const struct glint_dials *d = &like->asked;
    const double value[] = {
        d->irradiance_steps, d->snap_codes_q8, d->dispersion_q8,
        d->max_lights,       d->flags,         d->cull_codes,
        d->area_points,      like->apart_px,   like->cfg.tile_log2};

    add_values_to_hash(key, value, sizeof value / sizeof *value);
}

/* Returns the key of a response: a hash of model, library version, setup and
 * settings. It includes the aspect ratio of the picture, but not its size. It
 * includes BYTES, as too little memory makes grids coarser or omits ray
 * bundles. */
static uint64_t compute_cache_key(const struct glint_frame *like, size_t bytes)
{
    const struct glint_model_header *h = like->lens->header;
    const double shape[] = {(double)like->view.width / like->view.height,
                            like->view.sensor_width_mm, (double)bytes};
    const uint32_t model[] = {h->key[0], h->key[1], h->crc32, h->bytes,
                              REVISION};
    uint64_t key = UINT64_C(0xcbf29ce484222325);

    for (size_t i = 0; i < sizeof model / sizeof *model; i++)
        add_word_to_hash(&key, model[i]);
    for (const char *c = GLINT_VERSION; *c; c++)
        add_word_to_hash(&key, (unsigned char)*c);
    add_values_to_hash(&key, shape, sizeof shape / sizeof *shape);
    add_setup_to_hash(&key, like->setup);
    add_quality_parameters_to_hash(&key, like);
    return key;
}

/* -------------------------------------------------------------------- entry */

/* Sets AT to pointers to the members of R, in the order in which a cache entry
 * stores their values. */
static void list_response_values(struct glint_response *r, double *at[VALUES])
{
    int n = 0;

    for (int i = 0; i < GLINT_RESPONSE_ANGLES; i++) {
        at[n++] = &r->theta_deg[i];
        for (int c = 0; c < 3; c++) {
            at[n++] = &r->log2_of[i].peak[c];
            at[n++] = &r->log2_of[i].mean[c];
        }
    }
    for (int i = 0; i < GLINT_RESPONSE_EXTENTS; i++) {
        at[n++] = &r->extent[i];
        at[n++] = &r->softened_log2[i];
    }
}

static struct entry make_cache_entry(struct glint_response *r, uint64_t key)
{
    struct entry e = {.key = key, .n = r->n};
    double *at[VALUES];

    memcpy(e.magic, magic, sizeof magic);
    list_response_values(r, at);
    for (int i = 0; i < VALUES; i++)
        e.value[i] = *at[i];
    e.crc32 = glint_model_crc32(e.value, sizeof e.value);
    return e;
}

/* Returns whether all members of R are in the ranges that
 * glint_response_measure() can return. */
static bool is_response_in_range(const struct glint_response *r)
{
    if (r->n < 1 || r->n > GLINT_RESPONSE_ANGLES || r->theta_deg[0] != 0)
        return false;
    for (int i = 0; i < r->n; i++)
        if (!(r->theta_deg[i] <= 90) ||
            (i > 0 && !(r->theta_deg[i] > r->theta_deg[i - 1])))
            return false;
    for (int i = 0; i < GLINT_RESPONSE_EXTENTS; i++)
        if (!(r->extent[i] <= 100) || !(r->softened_log2[i] <= 0) ||
            !(r->softened_log2[i] >= -200) ||
            (i > 0 && !(r->extent[i] > r->extent[i - 1])))
            return false;
    return true;
}

static bool read_cache_entry(const struct entry *e, uint64_t key,
                             struct glint_response *r)
{
    double *at[VALUES];

    if (memcmp(e->magic, magic, sizeof magic) != 0 || e->key != key ||
        e->crc32 != glint_model_crc32(e->value, sizeof e->value))
        return false;
    *r = (struct glint_response){.n = e->n};
    list_response_values(r, at);
    for (int i = 0; i < VALUES; i++) {
        if (!(fabs(e->value[i]) <= 1000))
            return false;
        *at[i] = e->value[i];
    }
    return is_response_in_range(r);
}

/* -------------------------------------------------------------------- both */

enum glint_status
glint_response_measure_cached(const struct glint_frame *like, size_t bytes,
                              const struct glint_engine_cache *cache,
                              struct glint_response *response)
{
    const uint64_t key = like->lens ? compute_cache_key(like, bytes) : 0;
    const char *const name = like->lens ? like->lens->header->name : "";
    enum glint_status status;
    struct entry e;

    if (!like->lens)
        cache = NULL;
    if (cache && cache->read(cache->ctx, name, key, &e, sizeof e) &&
        read_cache_entry(&e, key, response))
        return GLINT_OK;
    *response = (struct glint_response){.n = 0};
    status = glint_response_measure(like, bytes, HUGE_VAL, response);
    if (status == GLINT_OK && cache) {
        e = make_cache_entry(response, key);
        cache->write(cache->ctx, name, key, &e, sizeof e);
    }
    return status;
}
