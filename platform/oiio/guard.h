/* SPDX-License-Identifier: MIT
 *
 * oiio/guard.h - turns exceptions into statuses, for the plug-in's files.
 */
#ifndef GLINT_PLATFORM_OIIO_GUARD_H
#define GLINT_PLATFORM_OIIO_GUARD_H

#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include <OpenImageIO/imageio.h>

#include "glint/image.h"
#include "glint/status.h"

namespace glint
{

/* Returns the bytes of the UTF-8 character at AT, or 0 if it is malformed or
 * a control character, U+0080 to U+009F among them. LEFT bytes of text are
 * left. */
inline size_t shown_bytes(const unsigned char *at, size_t left)
{
    const size_t n = at[0] < 0x80    ? 1
                     : at[0] >= 0xf0 ? 4
                     : at[0] >= 0xe0 ? 3
                                     : 2;

    if (n == 1)
        return at[0] >= ' ' && at[0] != 127;
    if (at[0] < 0xc2 || at[0] > 0xf4 || n > left ||
        (at[0] == 0xc2 && at[1] < 0xa0))
        return 0;
    for (size_t i = 1; i < n; i++)
        if ((at[i] & 0xc0) != 0x80)
            return 0;
    return n;
}

/* Returns TEXT as one line that is safe to print on a terminal, with '?' for
 * control characters. */
inline std::string printable(const std::string &text)
{
    std::string line;

    for (size_t i = 0; i < text.size();) {
        const size_t n = shown_bytes(
            reinterpret_cast<const unsigned char *>(text.data()) + i,
            text.size() - i);

        line += n ? text.substr(i, n) : text[i] == '\n' ? " " : "?";
        i += n ? n : 1;
    }
    return line;
}

struct failure {
    enum glint_status status;
    std::string cause;
};

/* Takes standard error away from the libraries behind OpenImageIO, which print
 * there what they also return as errors. */
class silence
{
    int kept = dup(STDERR_FILENO);

  public:
    silence()
    {
        const int null =
            kept < 0 ? -1 : open("/dev/null", O_WRONLY | O_CLOEXEC);

        std::fflush(stderr);
        if (null >= 0) {
            dup2(null, STDERR_FILENO);
            close(null);
        }
    }
    ~silence()
    {
        if (kept < 0)
            return;
        dup2(kept, STDERR_FILENO);
        close(kept);
    }
    silence(const silence &) = delete;
    silence &operator=(const silence &) = delete;
};

/* Runs BODY. If it throws, returns a status, with NAME and the cause in
 * ERROR. */
template <class Body>
enum glint_status guarded(const char *name, struct glint_error *error,
                          Body body)
{
    failure what = {GLINT_OK, ""};

    try {
        const silence quiet;

        body();
    } catch (const failure &f) {
        what = f;
    } catch (const std::bad_alloc &) {
        what = {GLINT_E_MEMORY, "not enough memory"};
    } catch (const std::exception &e) {
        what = {GLINT_E_FORMAT, e.what()};
    } catch (...) {
        what = {GLINT_E_FORMAT, "OpenImageIO failed"};
    }
    if (what.status) {
        const size_t len = std::strlen(name), most = 120;
        const bool cut = len > most;
        const std::string shown = printable(name + (cut ? len - most : 0));

        std::snprintf(error->text, sizeof error->text, "%s%s: %s",
                      cut ? "..." : "", shown.c_str(),
                      printable(what.cause).c_str());
    }
    return what.status;
}

/* Throws failure, before any memory is taken, if glint cannot read pictures
 * like SPEC. */
inline void check_spec(const OIIO::ImageSpec &spec)
{
    if (spec.deep || spec.nchannels < 1 || spec.depth > 1)
        throw failure{GLINT_E_UNSUPPORTED, "is not a flat picture"};
    if (spec.width < 1 || spec.height < 1 || spec.full_width < 1 ||
        spec.full_height < 1)
        throw failure{GLINT_E_FORMAT, "has no pixels"};
    if (spec.width > GLINT_MAX_SIDE || spec.height > GLINT_MAX_SIDE ||
        spec.full_width > GLINT_MAX_SIDE || spec.full_height > GLINT_MAX_SIDE)
        throw failure{GLINT_E_UNSUPPORTED, "larger than " +
                                               std::to_string(GLINT_MAX_SIDE) +
                                               " pixels a side"};
}

} // namespace glint

#endif
