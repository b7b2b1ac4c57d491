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

/* Return MADE with the metadata of FROM, a file of the same type, in place of
 * its own, but without FROM's profile if DROP_ICC. They return MADE as it is if
 * they cannot read one of the two. */
bytes carry_png(const bytes &made, const bytes &from, bool drop_icc);
bytes carry_jpeg(const bytes &made, const bytes &from, bool drop_icc);
bytes carry_webp(const bytes &made, const bytes &from, bool drop_icc);
bool is_classic_tiff(const bytes &file); /* BigTIFF is not. */
bytes carry_tiff(const bytes &made, const bytes &from, bool drop_icc);

/* Return in words what FILE lacks; "" if it is complete. */
std::string missing_of_jpeg(const bytes &file);
std::string missing_of_tiff(const bytes &file);

/* Returns the quality, 1 .. 100 on libjpeg's scale, whose tables are nearest to
 * FILE's; 0 if FILE has none. */
int quality_of_jpeg(const bytes &file);

bool is_progressive(const bytes &jpeg);

/* Returns whether the pixels of JPEG are C M Y K, which become R G B. */
bool is_of_inks(const bytes &jpeg);

/* Returns whether JPEG has more pictures after the first, which are lost. */
bool has_more_pictures(const bytes &jpeg);

/* Returns the data of the first chunk NAME of a PNG; empty if it has none. */
bytes chunk_of_png(const bytes &file, const char *name);

/* Returns whether WEBP is coded without loss. */
bool is_lossless(const bytes &webp);

/* -------------------------------------------------------------------- WebP */

/* Returns whether webp_decode() can decode FILE: a WebP without animation, if
 * this was built with libwebp. */
bool webp_takes(const bytes &file);

/* Returns the pixels of FILE in 8 bits: R G B A if CHANNELS is 4, else R G B.
 * Throws failure. */
bytes webp_decode(const bytes &file, int channels);

/* Returns PIXELS, 8 bits, as a WebP of QUALITY 1 .. 100, or 0: without loss.
 * Throws failure. */
bytes webp_encode(const unsigned char *pixels, int width, int height,
                  int channels, int quality);

/* ------------------------------------------------------------------- files */

struct kept_part {
    OIIO::ImageSpec spec; /* the part as it is stored */
    std::vector<unsigned char> pixels;
};

/* Returns whether each channel of a part has a type of its own. */
inline bool is_mixed(const OIIO::ImageSpec &spec)
{
    return !spec.channelformats.empty();
}

/* Returns whether metadata of files of TYPE, OpenImageIO's name of it, are
 * copied byte for byte. */
bool is_carried(const std::string &type);

/* Returns all bytes of the file PATH; throws failure. */
bytes read_whole(const char *path);

/* Sets DATA[N_BYTES] to a malloc'ed copy of ENCODED. */
void give(void **data, size_t *n_bytes, const bytes &encoded);

/* A file in memory, for writers that take no other. */
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

/* The functions of formats/oiio.h that keep a file as it is. */
enum glint_status open_file(struct glint_oiio_file **file,
                            struct glint_samples *samples,
                            struct glint_oiio_facts *facts, const char *path,
                            struct glint_error *error);
void close_file(struct glint_oiio_file *file);
int is_same_type(const struct glint_oiio_file *file, const char *path);
enum glint_status encode_file(void **data, size_t *bytes, const char *path,
                              struct glint_oiio_file *file,
                              const struct glint_samples *pixels,
                              const struct glint_oiio_options *options,
                              struct glint_error *error);

} // namespace glint

struct glint_oiio_file {
    std::string type;   /* OpenImageIO's name of the file type */
    glint::bytes whole; /* bytes of the file if is_carried(type) */
    std::vector<glint::kept_part> parts;
    std::vector<unsigned char> icc;
};

#endif
