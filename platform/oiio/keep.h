/* SPDX-License-Identifier: MIT
 *
 * oiio/keep.h - picture files with all that they hold.
 *
 * Metadata that OpenImageIO does not carry from file to file (chunks of PNG and
 * WebP, segments of JPEG and tags of TIFF) are copied byte for byte; WebP is
 * decoded and encoded by its own library, so that alpha stays straight.
 */
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

/* The carry functions return the file MADE with its metadata replaced by the
 * metadata of FROM, a file of the same type; without FROM's ICC profile if
 * DROP_ICC. They return MADE unchanged if they cannot read either file. */
bytes carry_png(const bytes &made, const bytes &from, bool drop_icc);
bytes carry_jpeg(const bytes &made, const bytes &from, bool drop_icc);
bytes carry_webp(const bytes &made, const bytes &from, bool drop_icc);
bool is_classic_tiff(const bytes &file); /* false for BigTIFF */
bytes carry_tiff(const bytes &made, const bytes &from, bool drop_icc);

/* Returns MADE, a TIFF, with the tags of EXIF, a TIFF without pixels, and XMP
 * added to its first directory. */
bytes add_to_tiff(const bytes &made, const bytes &exif, const std::string &xmp);

/* Removes from XMP, a packet, the properties that claim pictures or a video
 * behind the first picture: gain map, motion photo, container; if UPRIGHT, also
 * the orientation. Returns false and clears XMP if it has such properties and
 * is malformed. The time is linear in the size of XMP. */
bool remove_claims(std::string &xmp, bool upright);

/* Return as text what is missing in FILE, "" if it is complete. */
std::string missing_of_jpeg(const bytes &file);
std::string missing_of_tiff(const bytes &file);

/* Returns the quality, 1 .. 100 on libjpeg's scale, whose quantisation tables
 * are nearest to the tables of FILE; 0 if FILE has no tables. */
int quality_of_jpeg(const bytes &file);

bool is_progressive(const bytes &jpeg);

/* Returns whether the pixels of JPEG are CMYK, which glint converts to RGB. */
bool is_of_inks(const bytes &jpeg);

/* Returns as text the data after the first picture of JPEG, which glint loses;
 * "" if there are no such data. */
std::string more_of_jpeg(const bytes &jpeg);

/* Returns the data of the first chunk NAME of a PNG; empty if there is no such
 * chunk. */
bytes chunk_of_png(const bytes &file, const char *name);

/* Returns whether WEBP has several frames. */
bool is_animated_webp(const bytes &webp);

/* Returns whether WEBP is coded without loss. */
bool is_lossless(const bytes &webp);

/* ------------------------------------------------------------------- files */

/* Sets DATA[N_BYTES] to a malloc'ed copy of ENCODED. */
void give(void **data, size_t *n_bytes, const bytes &encoded);

/* A file in memory, for writers that need a file name. */
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
