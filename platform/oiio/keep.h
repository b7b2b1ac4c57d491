/* SPDX-License-Identifier: MIT
 *
 * oiio/keep.h - reads and writes picture files with all of their content.
 *
 * Metadata that OpenImageIO does not copy from file to file (chunks of PNG and
 * WebP, segments of JPEG and tags of TIFF) are copied byte for byte. WebP is
 * decoded and encoded by its own library, so that colours are not multiplied by
 * alpha. */
#ifndef GLINT_PLATFORM_OIIO_KEEP_H
#define GLINT_PLATFORM_OIIO_KEEP_H

#include <cstddef>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "formats/oiio.h"

namespace glint
{

using bytes = std::vector<unsigned char>;

/* The copy_*_metadata() functions return the file MADE with its metadata
 * replaced by those of FROM, a file of the same type. The ICC profile of FROM
 * is not copied if DROP_ICC is set. If a file cannot be parsed, they return
 * MADE unchanged. */
bytes copy_png_metadata(const bytes &made, const bytes &from, bool drop_icc);
bytes copy_jpeg_metadata(const bytes &made, const bytes &from, bool drop_icc);
bytes copy_webp_metadata(const bytes &made, const bytes &from, bool drop_icc);
bool is_classic_tiff(const bytes &file); /* Returns whether FILE is a TIFF, but
                                            not a BigTIFF. */
bytes copy_tiff_metadata(const bytes &made, const bytes &from, bool drop_icc);

/* Returns MADE, a TIFF, with the tags of EXIF (a TIFF without pixels) and XMP
 * added to its first directory. */
bytes add_metadata_to_tiff(const bytes &made, const bytes &exif,
                           const std::string &xmp);

/* Removes properties from the packet XMP that refer to pictures or a video
 * after the first picture of the file: gain map, motion photo, container. If
 * UPRIGHT is set, also removes the orientation. If XMP has such properties and
 * is malformed, clears it and returns false. The time is linear in the size of
 * XMP. */
bool remove_xmp_claims(std::string &xmp, bool upright);

/* Both functions return a text that states what is missing in a truncated FILE;
 * "" if FILE is complete. */
std::string describe_missing_jpeg_data(const bytes &file);
std::string describe_missing_tiff_data(const bytes &file);

/* Returns an estimate of FILE's quality, 1 .. 100: the quality at which the
 * quantisation tables of libjpeg are nearest to those of FILE. Returns 0 if
 * FILE has no tables. */
int estimate_jpeg_quality(const bytes &file);

bool is_progressive_jpeg(const bytes &jpeg);

/* Returns whether the pixels of JPEG are CMYK, which glint converts to RGB. */
bool is_cmyk_jpeg(const bytes &jpeg);

/* Returns a text that describes the data after the first picture of JPEG, which
 * glint does not preserve; "" if there are no such data. */
std::string describe_extra_jpeg_data(const bytes &jpeg);

/* Returns the data of the first chunk NAME of a PNG; empty if there is no such
 * chunk. */
bytes find_png_chunk(const bytes &file, const char *name);

bool is_animated_webp(const bytes &webp);

bool is_lossless(const bytes &webp);

/* ------------------------------------------------------------------- files */

/* Sets DATA[N_BYTES] to a malloc'ed copy of ENCODED. */
void copy_to_malloc(void **data, size_t *n_bytes, const bytes &encoded);

/* A file in memory that has a file name, for writers that need one. */
class memory_file
{
  public:
    memory_file();
    ~memory_file();
    memory_file(const memory_file &) = delete;
    memory_file &operator=(const memory_file &) = delete;

    std::string name() const;
    bytes contents() const; /* throws failure */

  private:
    int fd;
};

/* The functions of formats/oiio.h that preserve a file's content. */
enum glint_status open_file(struct glint_oiio_file **file,
                            struct glint_samples *samples,
                            struct glint_oiio_facts *facts, const char *path,
                            struct glint_error *error);
void close_file(struct glint_oiio_file *file);
int can_write(const char *path);
int is_same_type(const struct glint_oiio_file *file, const char *path);
enum glint_status encode_file(void **data, size_t *bytes, const char *path,
                              struct glint_oiio_file *file,
                              const struct glint_samples *pixels,
                              struct glint_oiio_options *options,
                              struct glint_error *error);

} // namespace glint

#endif
