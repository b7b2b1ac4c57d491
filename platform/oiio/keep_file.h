/* SPDX-License-Identifier: MIT
 *
 * oiio/keep_file.h - a file in memory, between its reading and its writing.
 */
#ifndef GLINT_PLATFORM_OIIO_KEEP_FILE_H
#define GLINT_PLATFORM_OIIO_KEEP_FILE_H

#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "oiio/carry.h"

namespace glint
{

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

} // namespace glint

struct glint_oiio_file {
    std::string type;   /* OpenImageIO's name of the file type */
    glint::bytes whole; /* bytes of the file if is_carried(type) */
    std::vector<glint::kept_part> parts;
    std::vector<unsigned char> icc;
};

#endif
