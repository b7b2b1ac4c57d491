/* SPDX-License-Identifier: MIT
 *
 * Reads a recorded motion block by block. A motion in memory is checked
 * completely when it is opened. If blocks are read from a file on demand, each
 * record is checked whenever it is read. */
#include "glint/scene/motion.h"

#include "base/blob.h"
#include "base/compiler.h"
#include "base/q.h"
#include "scene/valid.h"

/* The program reads the file in place: these structs are the file's layout. */
STATIC_ASSERT(sizeof(struct glint_motion_pose) == 20);
STATIC_ASSERT(sizeof(struct glint_motion_event) == 20);
STATIC_ASSERT(sizeof(struct glint_motion_sensor) == 12);
STATIC_ASSERT(sizeof(struct glint_motion_index) ==
              8 + 4 * GLINT_MOTION_MAX_FOODS);
STATIC_ASSERT(sizeof(struct glint_motion_header) == 180);
STATIC_ASSERT(sizeof(struct glint_motion_header) <= GLINT_MOTION_ROOM);

GLINT_BLOB_HEADER(struct glint_motion_header, variant);

static const char *const fault_text[GLINT_BLOB_FAULTS] =
    GLINT_BLOB_FAULT_TEXT("motion", "motions", "baked");

static const char outside[] = "damaged motion: a table lies outside the file";

/* ------------------------------------------------------------------ blocks */

uint32_t glint_motion_sum(const uint8_t *at, uint32_t block)
{
    const size_t skipped =
        block ? 0 : offsetof(struct glint_motion_header, variant);

    return glint_blob_compute_crc32(at + skipped,
                                    GLINT_MOTION_BLOCK - 4 - skipped);
}

/* Sets AT to the address of block BLOCK. Reads the block unless the motion is
 * in memory or the block was read last. Block 0 is always read. */
static enum glint_status get_file_block(struct glint_motion *m, uint32_t block,
                                        const uint8_t **at)
{
    const uint32_t *end;

    if (m->data) {
        *at = m->data + (size_t)block * GLINT_MOTION_BLOCK;
        return GLINT_OK;
    }
    *at = m->buffer;
    if (m->held == block && block > 0)
        return GLINT_OK;
    m->held = 0;
    if (block >= m->blocks.n_blocks ||
        !m->blocks.read(m->blocks.ctx, block, m->buffer))
        return GLINT_E_IO;
    end = (const uint32_t *)(const void *)(m->buffer + GLINT_MOTION_ROOM);
    if (end[0] != block || end[1] != glint_motion_sum(m->buffer, block))
        return GLINT_E_FORMAT;
    m->held = block;
    return GLINT_OK;
}

/* Sets RECORD to the address of record I, BYTES long, in the table that starts
 * in block BLOCK. */
static enum glint_status read_table_record(struct glint_motion *m,
                                           uint32_t block, uint32_t i,
                                           size_t bytes, const void **record)
{
    const uint32_t each = glint_motion_per_block(bytes);
    const uint8_t *at = NULL;
    const enum glint_status status = get_file_block(m, block + i / each, &at);

    *record = at + (size_t)(i % each) * bytes;
    return status;
}

/* ------------------------------------------------------------------- checks */

/* Returns the number of blocks that N records of BYTES bytes occupy. */
static uint64_t count_blocks(uint64_t n, size_t bytes)
{
    const uint64_t each = bytes ? glint_motion_per_block(bytes) : 1;

    return bytes ? (n + each - 1) / each : 0;
}

static uint32_t count_index_entries(const struct glint_motion_header *h)
{
    return (uint32_t)count_blocks(h->n_frames,
                                  sizeof(struct glint_motion_pose));
}

static const char *check_record_counts(const struct glint_motion_header *h)
{
    if (h->variant != 0)
        return "the motion file is of a variant that this glint does not know";
    if (h->n_frames < 1 || h->n_frames > GLINT_MOTION_MAX_FRAMES ||
        h->n_foods > GLINT_MOTION_MAX_FOODS ||
        h->n_sensors > GLINT_MOTION_MAX_SENSORS || h->n_events < h->n_foods ||
        h->n_events > (uint64_t)h->n_frames * h->n_foods)
        return "damaged motion: it has too many frames, food items, sensors or "
               "events";
    if (h->intensities != 0 && h->intensities != h->n_foods &&
        h->intensities != h->n_foods * h->n_sensors)
        return "damaged motion: the number of intensities is not that of food "
               "items times sensors";
    if (h->unit_log2 < -30 || h->unit_log2 > 60 || h->size < 0 ||
        h->size >= GLINT_MOTION_SPAN || h->cos_half_q30 < -(1 << 30) ||
        h->cos_half_q30 > 1 << 30 || h->tan_half_q24 < 1 << 12 ||
        h->tan_half_q24 > 1 << 30 || h->residual_frame >= h->n_frames)
        return "damaged motion: a unit, size or angle of view is out of range";
    for (int k = 0; k < 3; k++)
        if (h->low[k] <= -GLINT_MOTION_SPAN || h->high[k] < h->low[k] ||
            h->high[k] >= GLINT_MOTION_SPAN)
            return "damaged motion: the bounding box of the poses is out of "
                   "range";
    return NULL;
}

static const char *check_motion_header(const struct glint_motion_header *h,
                                       uint64_t n_blocks)
{
    const char *const wrong = check_record_counts(h);
    uint64_t block = 1;

    if (wrong)
        return wrong;
    if (h->sensor_block != block)
        return outside;
    block += count_blocks(h->n_sensors, sizeof(struct glint_motion_sensor));
    if (h->event_block != block)
        return outside;
    block += count_blocks(h->n_events, sizeof(struct glint_motion_event));
    if (h->index_block != block)
        return outside;
    block +=
        count_blocks(count_index_entries(h), sizeof(struct glint_motion_index));
    if (h->pose_block != block)
        return outside;
    block += count_index_entries(h);
    if (h->intensity_block != block)
        return outside;
    block += count_blocks(h->n_frames, h->intensities);
    return block == n_blocks ? NULL : outside;
}

/* Returns whether position AT lies in the box that the header states for all
 * positions. */
static int is_position_in_motion_box(const struct glint_motion_header *h,
                                     const int32_t at[3])
{
    for (int k = 0; k < 3; k++)
        if (at[k] < h->low[k] || at[k] > h->high[k])
            return 0;
    return 1;
}

static int is_valid_pose(const struct glint_motion_header *h,
                         const struct glint_motion_pose *p)
{
    int64_t square_q28 = 0;

    for (int k = 0; k < 4; k++)
        square_q28 += (int64_t)p->turn_q14[k] * p->turn_q14[k];
    /* Each component of the quaternion has an error of at most half a unit. So
     * the sum of squares has an error of at most 2^15. */
    return is_position_in_motion_box(h, p->at) &&
           square_q28 >= (1 << 28) - (1 << 16) &&
           square_q28 <= (1 << 28) + (1 << 16);
}

static int is_valid_event(const struct glint_motion_header *h,
                          const struct glint_motion_event *e)
{
    return e->frame < h->n_frames && e->slot < h->n_foods &&
           is_position_in_motion_box(h, e->at);
}

/* ----------------------------------------------------------------- records */

static enum glint_status read_event(struct glint_motion *m, uint32_t i,
                                    const struct glint_motion_event **event)
{
    const void *record = NULL;
    const enum glint_status status =
        read_table_record(m, m->header.event_block, i, sizeof **event, &record);

    *event = record;
    if (status != GLINT_OK)
        return status;
    return is_valid_event(&m->header, *event) ? GLINT_OK : GLINT_E_FORMAT;
}

enum glint_status glint_motion_event(struct glint_motion *motion, uint32_t i,
                                     struct glint_motion_event *event)
{
    const struct glint_motion_event *e = NULL;
    enum glint_status status = GLINT_E_ARGUMENT;

    if (i < motion->header.n_events)
        status = read_event(motion, i, &e);
    if (status == GLINT_OK)
        *event = *e;
    return status;
}

enum glint_status glint_motion_index(struct glint_motion *motion, uint32_t i,
                                     struct glint_motion_index *index)
{
    const struct glint_motion_header *h = &motion->header;
    const void *record = NULL;
    enum glint_status status = GLINT_E_ARGUMENT;

    if (i < count_index_entries(h))
        status = read_table_record(motion, h->index_block, i, sizeof *index,
                                   &record);
    if (status != GLINT_OK)
        return status;
    *index = *(const struct glint_motion_index *)record;
    if (index->event > h->n_events)
        return GLINT_E_FORMAT;
    for (uint32_t s = 0; s < h->n_foods; s++)
        if (index->food[s] >= index->event)
            return GLINT_E_FORMAT;
    return GLINT_OK;
}

/* Sets the position of each food item in frame K, from the events of frames 0
 * .. K. */
static enum glint_status
set_food_item_positions(struct glint_motion *m, uint32_t k,
                        struct glint_motion_frame *frame)
{
    const uint32_t each =
        glint_motion_per_block(sizeof(struct glint_motion_pose));
    const struct glint_motion_event *e = NULL;
    struct glint_motion_index index;
    enum glint_status status = glint_motion_index(m, k / each, &index);

    if (status != GLINT_OK)
        return status;
    for (uint32_t s = 0; status == GLINT_OK && s < m->header.n_foods; s++) {
        status = read_event(m, index.food[s], &e);
        if (status == GLINT_OK && (e->slot != s || e->frame > k))
            status = GLINT_E_FORMAT;
        for (int axis = 0; status == GLINT_OK && axis < 3; axis++)
            frame->food[s][axis] = e->at[axis];
    }
    for (uint32_t i = index.event; status == GLINT_OK && i < m->header.n_events;
         i++) {
        status = read_event(m, i, &e);
        if (status != GLINT_OK || e->frame > k)
            break;
        for (int axis = 0; axis < 3; axis++)
            frame->food[e->slot][axis] = e->at[axis];
    }
    return status;
}

static enum glint_status
set_food_item_intensities(struct glint_motion *m, uint32_t k,
                          struct glint_motion_frame *frame)
{
    const struct glint_motion_header *h = &m->header;
    const int each = h->intensities == h->n_foods * h->n_sensors;
    const void *record = NULL;
    const uint8_t *from;
    enum glint_status status = GLINT_OK;

    if (h->intensities)
        status = read_table_record(m, h->intensity_block, k, h->intensities,
                                   &record);
    from = record;
    for (uint32_t f = 0; status == GLINT_OK && f < h->n_foods; f++)
        for (uint32_t s = 0; s < h->n_sensors; s++)
            frame->intensity[f][s] = !h->intensities ? 255
                                     : each ? from[f * h->n_sensors + s]
                                            : from[f];
    return status;
}

enum glint_status glint_motion_frame(struct glint_motion *motion, uint32_t k,
                                     struct glint_motion_frame *frame)
{
    const struct glint_motion_header *h = &motion->header;
    const void *record = NULL;
    enum glint_status status;

    if (k >= h->n_frames)
        return GLINT_E_ARGUMENT;
    status = read_table_record(motion, h->pose_block, k, sizeof frame->pose,
                               &record);
    if (status == GLINT_OK) {
        frame->pose = *(const struct glint_motion_pose *)record;
        status = is_valid_pose(h, &frame->pose) ? GLINT_OK : GLINT_E_FORMAT;
    }
    if (status == GLINT_OK)
        status = set_food_item_positions(motion, k, frame);
    return status == GLINT_OK ? set_food_item_intensities(motion, k, frame)
                              : status;
}

/* --------------------------------------------------------------------- open */

/* Copies the sensors from the file to the motion. Returns the text of an error,
 * or NULL. */
static const char *copy_sensors_from_file(struct glint_motion *m)
{
    for (uint32_t i = 0; i < m->header.n_sensors; i++) {
        const void *record = NULL;

        if (read_table_record(m, m->header.sensor_block, i, sizeof *m->sensor,
                              &record) != GLINT_OK)
            return "damaged motion: the sensors cannot be read";
        m->sensor[i] = *(const struct glint_motion_sensor *)record;
        if (!glint_scene_is_unit_vector(m->sensor[i].axis_q30, 3))
            return "damaged motion: a sensor's axis is not a unit vector";
    }
    return NULL;
}

static const char *check_poses(struct glint_motion *m)
{
    for (uint32_t i = 0; i < m->header.n_frames; i++) {
        const void *pose = NULL;

        if (read_table_record(m, m->header.pose_block, i,
                              sizeof(struct glint_motion_pose),
                              &pose) != GLINT_OK ||
            !is_valid_pose(&m->header, pose))
            return "damaged motion: a pose is out of range";
    }
    return NULL;
}

/* Checks that the events (replacements of food items) are sorted by frame, and
 * that the first events state the position of each food item. */
static const char *check_events(struct glint_motion *m)
{
    uint32_t last = 0;

    for (uint32_t i = 0; i < m->header.n_events; i++) {
        const struct glint_motion_event *e = NULL;

        if (read_event(m, i, &e) != GLINT_OK || e->frame < last ||
            (i < m->header.n_foods && (e->slot != i || e->frame)))
            return "damaged motion: a change of a food item's position is "
                   "unsorted or out of range";
        last = e->frame;
    }
    return NULL;
}

/* Checks that the index, which states the food items at the start of each block
 * of poses, agrees with the events. */
static const char *check_event_index(struct glint_motion *m)
{
    const uint32_t each =
        glint_motion_per_block(sizeof(struct glint_motion_pose));
    uint32_t food[GLINT_MOTION_MAX_FOODS] = {0};
    uint32_t event = 0;

    for (uint32_t block = 0; block < count_index_entries(&m->header); block++) {
        const struct glint_motion_event *e = NULL;
        struct glint_motion_index index;
        int fits;

        for (; event < m->header.n_events &&
               read_event(m, event, &e) == GLINT_OK && e->frame <= block * each;
             event++)
            food[e->slot] = event;
        fits = glint_motion_index(m, block, &index) == GLINT_OK &&
               index.event == event;
        for (uint32_t s = 0; fits && s < m->header.n_foods; s++)
            fits = index.food[s] == food[s];
        if (!fits)
            return "damaged motion: the index does not match the changes of "
                   "the food items' positions";
    }
    return NULL;
}

enum glint_status glint_motion_open(struct glint_motion *motion,
                                    const void *data, size_t bytes,
                                    const char **reason)
{
    static const struct glint_blob_kind kind = {
        GLINT_MOTION_MAGIC, GLINT_MOTION_VERSION,
        sizeof(struct glint_motion_header)};
    struct glint_blob blob;

    *reason = fault_text[glint_blob_open(&blob, &kind, data, bytes)];
    if (!*reason)
        *reason = fault_text[glint_blob_check_name(&blob)];
    if (*reason)
        return GLINT_E_FORMAT;
    motion->header = *(const struct glint_motion_header *)data;
    motion->data = data;
    motion->held = 0;
    *reason =
        bytes % GLINT_MOTION_BLOCK
            ? outside
            : check_motion_header(&motion->header, bytes / GLINT_MOTION_BLOCK);
    if (!*reason)
        *reason = copy_sensors_from_file(motion);
    if (!*reason)
        *reason = check_poses(motion);
    if (!*reason)
        *reason = check_events(motion);
    if (!*reason)
        *reason = check_event_index(motion);
    return *reason ? GLINT_E_FORMAT : GLINT_OK;
}

enum glint_status glint_motion_over(struct glint_motion *motion,
                                    const struct glint_motion_blocks *blocks,
                                    uint8_t *buffer, const char **reason)
{
    const uint8_t *first = NULL;
    enum glint_status status;

    motion->data = NULL;
    motion->blocks = *blocks;
    motion->buffer = buffer;
    motion->held = 0;
    status = get_file_block(motion, 0, &first);
    *reason = status == GLINT_OK
                  ? NULL
                  : "the first block of the motion file cannot be read";
    if (status != GLINT_OK)
        return status;
    motion->header = *(const struct glint_motion_header *)(const void *)first;
    if (motion->header.magic != GLINT_MOTION_MAGIC)
        *reason = fault_text[GLINT_BLOB_FOREIGN];
    else if (motion->header.version != GLINT_MOTION_VERSION)
        *reason = fault_text[motion->header.version > GLINT_MOTION_VERSION
                                 ? GLINT_BLOB_NEWER
                                 : GLINT_BLOB_OLDER];
    else
        *reason = check_motion_header(&motion->header, blocks->n_blocks);
    if (!*reason &&
        motion->header.bytes / GLINT_MOTION_BLOCK != blocks->n_blocks)
        *reason = fault_text[GLINT_BLOB_TRUNCATED];
    if (!*reason)
        *reason = fault_text[glint_blob_check_name(
            &(struct glint_blob){.header = (const void *)&motion->header})];
    if (!*reason)
        *reason = copy_sensors_from_file(motion);
    return *reason ? GLINT_E_FORMAT : GLINT_OK;
}
