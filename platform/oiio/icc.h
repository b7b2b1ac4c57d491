/* SPDX-License-Identifier: MIT
 *
 * oiio/icc.h - colours by ICC profiles of tables (CMYK, printers, scanners),
 * through lcms2: relative colorimetric, with black point compensation. glint
 * itself reads profiles of curves and a matrix (formats/tones.h).
 *
 *     const auto link = open_icc_link(profile, layout, true);
 *     bytes rgb = link->decode(codes);
 *     ... add light to rgb ...
 *     if (link->can_encode)
 *         link->encode(rgb, codes);
 */
#ifndef GLINT_PLATFORM_OIIO_ICC_H
#define GLINT_PLATFORM_OIIO_ICC_H

#include <cstddef>
#include <memory>

#include "oiio/keep.h"

namespace glint
{

/* Interleaved codes: 1 colour (grey), 3 (R G B) or 4 (C M Y K, 0 is no ink),
 * then straight alpha, in samples of 1 or 2 bytes. */
struct code_layout {
    size_t n_colours;
    bool has_alpha;
    size_t sample_bytes;
};

/* RGB of links that can encode: it holds most colours of inks. Chromaticities
 * x, y are those of red, green, blue and white of BT.2020. */
constexpr double wide_gamma = 2.2;
constexpr double wide_primaries[4][2] = {
    {0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, {0.3127, 0.329}};

struct icc_link {
    code_layout codes;
    code_layout rgb; /* 16 bits, wide, if it can encode; else sRGB, depth of
                        the codes */
    bool can_encode;

    virtual ~icc_link() = default;
    virtual bytes decode(const bytes &codes) const = 0;

    /* Replaces the pixels of CODES that do not decode to those of RGB; the
     * others stay bit for bit. */
    virtual void encode(const bytes &rgb, bytes &codes) const = 0;
};

/* Returns the link of PROFILE, which can encode if MAY_ENCODE is set and
 * PROFILE has a table for that. Returns NULL if PROFILE is malformed, above 16
 * MiB, of curves and a matrix, or not for colours of LAYOUT, or if this plug-in
 * was built without lcms2. */
std::unique_ptr<icc_link>
open_icc_link(const bytes &profile, const code_layout &layout, bool may_encode);

/* Returns C M Y K, 8 bits, 0 is no ink, of FILE, a JPEG of WIDTH x HEIGHT
 * pixels of inks. Throws failure. */
bytes inks_of_jpeg(const bytes &file, int width, int height);

} // namespace glint

#endif
