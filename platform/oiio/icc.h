/* SPDX-License-Identifier: MIT
 *
 * oiio/icc.h - converts colours by ICC profiles that consist of tables (CMYK,
 * printers, scanners), through lcms2: relative colorimetric, with black point
 * compensation. glint itself reads profiles of curves and a matrix
 * (formats/tones.h).
 *
 *     const auto link = open_icc_link(profile, layout, true);
 *     bytes rgb = link->decode(codes);
 *     ... add light to rgb ...
 *     if (link->can_encode)
 *         link->encode(rgb, codes); */
#ifndef GLINT_PLATFORM_OIIO_ICC_H
#define GLINT_PLATFORM_OIIO_ICC_H

#include <cstddef>
#include <memory>

#include "oiio/keep.h"

namespace glint
{

/* Layout of interleaved codes: 1 colour (grey), 3 (R G B) or 4 (C M Y K, where
 * 0 is no ink), then alpha. Colours are not multiplied by alpha. Samples have 1
 * or 2 bytes. */
struct code_layout {
    size_t n_colours;
    bool has_alpha;
    size_t sample_bytes;
};

/* The RGB of conversions that can encode. wide_gamma: its gamma.
 * wide_primaries: the primaries of BT.2020, which include most colours of inks,
 * as chromaticities x, y of red, green, blue and white. */
constexpr double wide_gamma = 2.2;
constexpr double wide_primaries[4][2] = {
    {0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, {0.3127, 0.329}};

struct icc_link {
    code_layout codes;
    /* Layout of RGB: 16 bits with wide primaries if can_encode is set; else
     * sRGB with the bit depth of the codes. */
    code_layout rgb;
    bool can_encode;

    virtual ~icc_link() = default;
    virtual bytes decode(const bytes &codes) const = 0;

    /* Compares CODES with the pixels RGB. Where a pixel of CODES does not
     * decode to its pixel in RGB, replaces it by codes that nearly do. Other
     * pixels do not change. */
    virtual void encode(const bytes &rgb, bytes &codes) const = 0;
};

/* Returns the conversion by PROFILE between codes and RGB. can_encode is set if
 * MAY_ENCODE is set and PROFILE has a table for encoding. Returns NULL if
 * PROFILE is malformed, larger than 16 MiB, consists of curves and a matrix or
 * float tables, or is not for the colours of LAYOUT, or if this plug-in was
 * built without lcms2. */
std::unique_ptr<icc_link>
open_icc_link(const bytes &profile, const code_layout &layout, bool may_encode);

/* Returns the pixels of FILE, a CMYK JPEG of WIDTH x HEIGHT pixels, as C M Y K
 * in 8 bits, where 0 is no ink. Throws failure. */
bytes decode_cmyk_jpeg(const bytes &file, int width, int height);

} // namespace glint

#endif
