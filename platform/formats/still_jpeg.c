/* SPDX-License-Identifier: MIT */
#include "formats/still_codec.h"

#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <jerror.h>
#include <jpeglib.h>

#include "posix/error.h"

enum {
    APP0 = 0xe0,
    COMMENT = 0xfe,
    SOS = 0xda,
    MAX_SCANS = 500,    /* max scans of a file; each costs a pass over it */
    MAX_STEP = 8191,    /* max quantisation step: libjpeg-turbo divides by 8
                           times the step, in 16 bits */
    OUTPUT_BYTES = 4096 /* bytes that libjpeg writes at once */
};

static const char exif_head[6] = "Exif\0";

/* A call of libjpeg: an error leaves it by a jump to ESCAPE. */
struct call {
    struct jpeg_decompress_struct in;
    struct jpeg_compress_struct out;
    struct jpeg_error_mgr errors;
    jmp_buf escape;
    enum glint_status status;
    struct glint_error *error;
    const char *path;
    char *note; /* of the file that is read, or NULL */
    struct jpeg_progress_mgr progress;
    struct jpeg_destination_mgr output;
    struct still_bytes *to;
    JOCTET buffer[OUTPUT_BYTES];
};

static void leave_libjpeg(struct call *c, enum glint_status status,
                          const char *cause)
{
    c->status = glint_error_report(c->error, status, c->path, "%s", cause);
    longjmp(c->escape, 1);
}

static void on_error(j_common_ptr jpeg)
{
    struct call *const c = jpeg->client_data;
    char text[JMSG_LENGTH_MAX];

    jpeg->err->format_message(jpeg, text);
    leave_libjpeg(c,
                  jpeg->err->msg_code == JERR_OUT_OF_MEMORY ? GLINT_E_MEMORY
                  : !jpeg->is_decompressor                  ? GLINT_E_OUTPUT
                                                            : GLINT_E_FORMAT,
                  text);
}

/* Messages with LEVEL >= 0 are not warnings. */
static void on_message(j_common_ptr jpeg, int level)
{
    struct call *const c = jpeg->client_data;
    char text[JMSG_LENGTH_MAX];

    if (level >= 0 || !c->note)
        return;
    if (jpeg->err->msg_code == JWRN_JPEG_EOF)
        leave_libjpeg(c, GLINT_E_FORMAT,
                      "is cut off: its end marker is missing");
    if (*c->note)
        return;
    jpeg->err->format_message(jpeg, text);
    snprintf(c->note, STILL_NOTE_BYTES, "%.100s", text);
}

static void on_output(j_common_ptr jpeg)
{
    (void)jpeg;
}

static void init_call(struct call *c, const char *path,
                      struct glint_error *error)
{
    memset(c, 0, sizeof *c);
    c->path = path;
    c->error = error;
    c->in.err = c->out.err = jpeg_std_error(&c->errors);
    c->in.client_data = c->out.client_data = c;
    c->errors.error_exit = on_error;
    c->errors.emit_message = on_message;
    c->errors.output_message = on_output;
}

/* ----------------------------------------------------------------- reading */

static void start_reading(struct call *c, const struct still_file *file)
{
    jpeg_create_decompress(&c->in);
    jpeg_mem_src(&c->in, file->data, file->bytes);
    jpeg_save_markers(&c->in, JPEG_APP0 + 2, 0xffff); /* ICC profile */
    jpeg_read_header(&c->in, TRUE);
}

static void check_scans(j_common_ptr jpeg)
{
    struct call *const c = jpeg->client_data;

    if (c->in.input_scan_number > MAX_SCANS)
        leave_libjpeg(c, GLINT_E_UNSUPPORTED, "has more than 500 scans");
}

static void read_rows(struct call *c, struct still_file *file)
{
    struct still_pixels *const p = &file->pixels;
    unsigned n_icc = 0;

    start_reading(c, file);
    if (c->in.num_components != 1 && c->in.num_components != 3)
        leave_libjpeg(c, GLINT_E_UNSUPPORTED, "CMYK " STILL_NEEDS_PLUGIN);
    c->in.out_color_space = c->in.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    *p = (struct still_pixels){.width = (int)c->in.image_width,
                               .height = (int)c->in.image_height,
                               .channels = c->in.num_components,
                               .sample_bytes = 1};
    c->status = glint_still_allocate(file, c->error);
    if (c->status)
        longjmp(c->escape, 1);
    if (jpeg_read_icc_profile(&c->in, &file->icc, &n_icc))
        file->icc_bytes = n_icc;
    c->progress.progress_monitor = check_scans;
    c->in.progress = &c->progress;
    jpeg_start_decompress(&c->in);
    while (c->in.output_scanline < c->in.output_height) {
        JSAMPROW row = p->mem + (size_t)c->in.output_scanline *
                                    (size_t)p->width * (size_t)p->channels;

        jpeg_read_scanlines(&c->in, &row, 1);
    }
    jpeg_finish_decompress(&c->in);
}

static enum glint_status decode(struct still_file *file,
                                struct glint_error *error)
{
    struct call c;

    init_call(&c, file->path, error);
    c.note = file->note;
    if (setjmp(c.escape)) {
        jpeg_destroy_decompress(&c.in);
        return c.status;
    }
    read_rows(&c, file);
    glint_still_note_rest(file, c.in.src->bytes_in_buffer);
    jpeg_destroy_decompress(&c.in);
    return GLINT_OK;
}

/* ----------------------------------------------------------------- writing */

static void start_output(j_compress_ptr jpeg)
{
    struct call *const c = jpeg->client_data;

    c->output.next_output_byte = c->buffer;
    c->output.free_in_buffer = OUTPUT_BYTES;
}

static boolean flush_output(j_compress_ptr jpeg)
{
    struct call *const c = jpeg->client_data;

    glint_still_append(c->to, c->buffer, OUTPUT_BYTES);
    start_output(jpeg);
    return TRUE;
}

static void end_output(j_compress_ptr jpeg)
{
    struct call *const c = jpeg->client_data;

    glint_still_append(c->to, c->buffer,
                       OUTPUT_BYTES - c->output.free_in_buffer);
}

/* Returns whether libjpeg can encode with TABLE. NULL: a table that is not in
 * front of the first scan. */
static bool is_usable(const JQUANT_TBL *table)
{
    for (int i = 0; table && i < DCTSIZE2; i++)
        if (table->quantval[i] < 1 || table->quantval[i] > MAX_STEP)
            return false;
    return table != NULL;
}

/* Returns whether libjpeg can encode with the tables and the subsampling of the
 * file that c->in reads. */
static bool is_coding_usable(const struct call *c)
{
    bool is_good = true;
    int blocks = 0;

    for (int i = 0; i < c->in.num_components; i++) {
        const jpeg_component_info *const from = &c->in.comp_info[i];

        blocks += from->h_samp_factor * from->v_samp_factor;
        /* libjpeg checks the number only of components that a scan has. */
        is_good = is_good && from->quant_tbl_no < NUM_QUANT_TBLS &&
                  is_usable(c->in.quant_tbl_ptrs[from->quant_tbl_no]);
    }
    return is_good &&
           (c->in.num_components == 1 || blocks <= C_MAX_BLOCKS_IN_MCU);
}

/* Sets subsampling, and unless KEEPS_TABLES is false the quantisation tables,
 * to those of the file that c->in reads. */
static void copy_coding(struct call *c, bool keeps_tables)
{
    for (int i = 0; i < c->out.num_components; i++) {
        const jpeg_component_info *const from = &c->in.comp_info[i];
        jpeg_component_info *const to = &c->out.comp_info[i];
        JQUANT_TBL **const table = &c->out.quant_tbl_ptrs[from->quant_tbl_no];

        to->h_samp_factor = from->h_samp_factor;
        to->v_samp_factor = from->v_samp_factor;
        if (!keeps_tables)
            continue;
        to->quant_tbl_no = from->quant_tbl_no;
        if (!*table)
            *table = jpeg_alloc_quant_table((j_common_ptr)&c->out);
        **table = *c->in.quant_tbl_ptrs[from->quant_tbl_no];
        (*table)->sent_table = FALSE;
    }
}

/* Sets quality and subsampling, those of the file LIKE if it is not NULL. */
static void set_coding(struct call *c, const struct still_source *from)
{
    jpeg_set_quality(&c->out, from->quality ? from->quality : 95, TRUE);
    if (!from->like)
        return;
    c->out.write_JFIF_header = FALSE; /* that of LIKE will be added */
    start_reading(c, from->like);
    if (is_coding_usable(c)) {
        copy_coding(c, !from->quality);
    } else {
        for (int i = 0; i < c->out.num_components; i++)
            c->out.comp_info[i].h_samp_factor =
                c->out.comp_info[i].v_samp_factor = 1;
        snprintf(from->said, STILL_NOTE_BYTES,
                 "libjpeg cannot write its quantisation or subsampling: "
                 "quality %d without subsampling",
                 from->quality ? from->quality : 95);
    }
    if (c->in.progressive_mode)
        jpeg_simple_progression(&c->out);
}

static void write_exif(struct call *c, const struct still_source *from)
{
    jpeg_write_m_header(&c->out, JPEG_APP0 + 1,
                        (unsigned)(sizeof exif_head + from->exif_bytes));
    for (size_t i = 0; i < sizeof exif_head; i++)
        jpeg_write_m_byte(&c->out, exif_head[i]);
    for (size_t i = 0; i < from->exif_bytes; i++)
        jpeg_write_m_byte(&c->out, from->exif[i]);
}

static void write_file(struct call *c, const struct still_source *from)
{
    const struct still_pixels *const p = from->pixels;

    jpeg_create_compress(&c->out);
    c->output.init_destination = start_output;
    c->output.empty_output_buffer = flush_output;
    c->output.term_destination = end_output;
    c->out.dest = &c->output;
    c->out.image_width = (JDIMENSION)p->width;
    c->out.image_height = (JDIMENSION)p->height;
    c->out.input_components = p->channels;
    c->out.in_color_space = p->channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&c->out);
    set_coding(c, from);
    jpeg_start_compress(&c->out, TRUE);
    if (from->exif)
        write_exif(c, from);
    if (from->icc)
        jpeg_write_icc_profile(&c->out, from->icc, (unsigned)from->icc_bytes);
    while (c->out.next_scanline < c->out.image_height) {
        JSAMPROW row = p->mem + (size_t)c->out.next_scanline *
                                    (size_t)p->width * (size_t)p->channels;

        jpeg_write_scanlines(&c->out, &row, 1);
    }
    jpeg_finish_compress(&c->out);
}

static enum glint_status encode(struct still_bytes *to, const char *path,
                                const struct still_source *from,
                                struct glint_error *error)
{
    struct call c;

    init_call(&c, path, error);
    c.to = to;
    if (setjmp(c.escape) == 0)
        write_file(&c, from);
    jpeg_destroy_decompress(&c.in);
    jpeg_destroy_compress(&c.out);
    return c.status;
}

/* ---------------------------------------------------------------- segments */

static bool next_piece(struct still_piece *piece, const uint8_t *data,
                       size_t bytes, size_t *at)
{
    size_t i = *at ? *at : 2, n;

    /* Bytes 0xff in front of a marker, which itself begins with 0xff, are
     * padding. */
    while (i + 4 <= bytes && data[i] == 0xff && data[i + 1] == 0xff)
        i++;
    if (i + 4 > bytes || data[i] != 0xff)
        return false;
    n = data[i + 1] == SOS ? bytes - i - 2
                           : (size_t)data[i + 2] << 8 | data[i + 3];
    if (n < 2 || n + 2 > bytes - i)
        return false;
    *piece = (struct still_piece){.marker = data[i + 1],
                                  .whole = data + i,
                                  .whole_bytes = n + 2,
                                  .data = data + i + 4,
                                  .data_bytes = n - 2};
    *at = i + n + 2;
    return true;
}

static bool begins_with(const struct still_piece *piece, const char *text,
                        size_t n)
{
    return piece->data_bytes >= n && memcmp(piece->data, text, n) == 0;
}

static bool contains(const struct still_piece *piece, const char *text)
{
    const size_t n = strlen(text);

    for (size_t i = 0; i + n <= piece->data_bytes; i++)
        if (memcmp(piece->data + i, text, n) == 0)
            return true;
    return false;
}

/* Returns the content of a segment APP1, of which XMP may describe pictures and
 * videos behind the first picture. */
static enum still_content classify_app1(const struct still_piece *piece)
{
    if (begins_with(piece, exif_head, sizeof exif_head))
        return STILL_EXIF;
    return contains(piece, "hdrgm:") || contains(piece, "Container:Item") ||
                   contains(piece, "Camera:MotionPhoto") ||
                   contains(piece, "Camera:MicroVideo")
               ? STILL_EXTRA
               : STILL_OTHER;
}

static enum still_content classify(const struct still_piece *piece)
{
    switch (piece->marker) {
    case APP0: /* JFIF states Y'CbCr; it may state a resolution, in inches or
                  cm, or have a preview */
        return begins_with(piece, "JFIF", 5) && piece->data_bytes == 14 &&
                       piece->data[7] == 0
                   ? STILL_COLOURS
                   : STILL_OTHER;
    case APP0 + 1:
        return classify_app1(piece);
    case APP0 + 2:
        return begins_with(piece, "ICC_PROFILE", 12) ? STILL_COLOURS
               : begins_with(piece, "MPF", 4) ||
                       begins_with(piece, "urn:iso:std:iso:ts:21496:-1", 28)
                   ? STILL_EXTRA
                   : STILL_OTHER;
    case APP0 + 14: /* Adobe's: how the pixels are coded */
        return STILL_CODING;
    case APP0 + 11: /* JUMBF, of which C2PA signs the pixels */
        return STILL_BOUND;
    }
    return (piece->marker > APP0 && piece->marker <= APP0 + 15) ||
                   piece->marker == COMMENT
               ? STILL_OTHER
               : STILL_CODING;
}

const struct still_codec glint_still_jpeg = {
    .type = "JPEG",
    .extensions = {".jpg", ".jpeg"},
    .decode = decode,
    .encode = encode,
    .next_piece = next_piece,
    .classify = classify,
    .head_bytes = 2,
    .exif_head_bytes = sizeof exif_head,
    .exif_max_bytes = 65533 - sizeof exif_head,
};
