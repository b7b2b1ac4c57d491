/* SPDX-License-Identifier: MIT
 *
 * oiio/guard.h - converts exceptions to status codes, for the plug-in's
 * files.
 */
#ifndef GLINT_PLATFORM_OIIO_GUARD_H
#define GLINT_PLATFORM_OIIO_GUARD_H

#include <atomic>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include "glint/image.h"
#include "glint/status.h"

namespace glint
{

/* Returns the length in bytes of the UTF-8 character at AT, or 0 if it is
 * malformed or a control character (also U+0080 to U+009F). LEFT is the number
 * of bytes from AT to the end of the text. */
inline size_t get_printable_utf8_length(const unsigned char *at, size_t left)
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

/* Returns TEXT as one line that is safe to print on a terminal: newlines become
 * spaces, other control characters and malformed ones '?'. */
inline std::string make_printable(const std::string &text)
{
    std::string line;

    for (size_t i = 0; i < text.size();) {
        const size_t n = get_printable_utf8_length(
            reinterpret_cast<const unsigned char *>(text.data()) + i,
            text.size() - i);

        line += n ? text.substr(i, n) : text[i] == '\n' ? " " : "?";
        i += n ? n : 1;
    }
    return line;
}

/* Returns CAUSE, a message of OpenImageIO, with NAME replaced by "the file",
 * because glint prints NAME before the message. Returns FALLBACK if CAUSE is
 * empty. */
inline std::string remove_file_name(std::string cause, const std::string &name,
                                    const char *fallback)
{
    const std::string quoted = '"' + name + '"';

    for (const std::string &own : {"file " + quoted, quoted})
        for (size_t at = 0; (at = cause.find(own, at)) != std::string::npos;
             at += 8)
            cause.replace(at, own.size(), "the file");
    return cause.empty() ? fallback : cause;
}

struct failure {
    enum glint_status status;
    std::string cause;
};

/* The calls of the plug-in that are running, in all threads. */
struct calls {
    std::mutex lock;
    std::atomic<int> n{0};
    std::atomic<int> err{-1}; /* duplicate of standard error while calls are
                                 running */
    /* message that report_abort() prints; names the file of the latest call */
    char text[256] = "";
};

inline calls under_way;

/* A running call for the file NAME. While it exists, standard error is
 * /dev/null, because OpenImageIO's libraries both return errors and print them
 * there. */
class call
{
  public:
    explicit call(const char *name)
    {
        const std::string shown = shorten(name);
        const std::lock_guard<std::mutex> held(under_way.lock);

        std::snprintf(under_way.text, sizeof under_way.text,
                      "glint: %s: OpenImageIO aborted on this file; convert it "
                      "with another program\n",
                      shown.c_str());
        if (under_way.n++ == 0)
            silence_stderr();
    }
    ~call()
    {
        const std::lock_guard<std::mutex> held(under_way.lock);
        const int err = under_way.err;

        if (--under_way.n > 0 || err < 0)
            return;
        under_way.err = -1;
        dup2(err, STDERR_FILENO);
        close(err);
    }
    call(const call &) = delete;
    call &operator=(const call &) = delete;

    /* Returns the end of NAME that fits a message, with control characters
     * replaced. */
    static std::string shorten(const char *name)
    {
        const size_t len = std::strlen(name), most = 120;

        return len > most ? "..." + make_printable(name + len - most)
                          : make_printable(name);
    }

  private:
    static void silence_stderr()
    {
        const int err = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
        const int null = err < 0 ? -1 : open("/dev/null", O_WRONLY | O_CLOEXEC);

        std::fflush(stderr);
        if (null >= 0) {
            dup2(null, STDERR_FILENO);
            close(null);
        }
        under_way.err = err;
    }
};

/* If a call of the plug-in is running, prints to glint's standard error that
 * OpenImageIO has aborted, and returns 1. Otherwise returns 0.
 * Async-signal-safe. */
inline int report_abort()
{
    const int err = under_way.err;

    if (under_way.n == 0)
        return 0;
    (void)!write(err < 0 ? STDERR_FILENO : err, under_way.text,
                 std::strlen(under_way.text));
    return 1;
}

/* Runs BODY, which reads or writes the file NAME. If it throws, sets ERROR to
 * NAME and the cause and returns the exception's status, or UNKNOWN if it has
 * no status. */
template <class Body>
enum glint_status guarded(const char *name, enum glint_status unknown,
                          struct glint_error *error, Body body) noexcept
try {
    failure what = {GLINT_OK, ""};

    try {
        const call now(name);

        body();
    } catch (const failure &f) {
        what = f;
    } catch (const std::bad_alloc &) {
        what = {GLINT_E_MEMORY, "not enough memory"};
    } catch (const std::exception &e) {
        what = {unknown, std::string("OpenImageIO failed: ") + e.what()};
    } catch (...) {
        what = {unknown, "OpenImageIO failed"};
    }
    if (what.status)
        std::snprintf(
            error->text, sizeof error->text, "%s: %s",
            call::shorten(name).c_str(),
            make_printable(remove_file_name(
                               what.cause, name,
                               unknown == GLINT_E_OUTPUT
                                   ? "cannot be written"
                                   : "cannot be read: it is damaged, or not of "
                                     "the type that its extension states"))
                .c_str());
    return what.status;
} catch (...) {
    std::snprintf(error->text, sizeof error->text,
                  "not enough memory for a picture");
    return GLINT_E_MEMORY;
}

/* Throws failure if IN reads videos: OpenImageIO's video reader also opens the
 * files that a playlist names. */
inline void reject_video_reader(const OIIO::ImageInput *in)
{
    if (in && OIIO::Strutil::istarts_with(in->format_name(), "ffmpeg"))
        throw failure{GLINT_E_UNSUPPORTED, "is a video, not a picture"};
}

/* Returns ERROR, OpenImageIO's reason for not opening a file, or a message of
 * glint if the file is not an image. */
inline std::string describe_open_error(const std::string &error)
{
    const bool is_image = !OIIO::Strutil::contains(error, "format reader") &&
                          !OIIO::Strutil::contains(error, "magic number");

    return is_image ? error
                    : "not an image in a format that glint reads (PPM, PFM, "
                      "PNG, JPEG, TIFF, OpenEXR, WebP and more)";
}

/* Opens the picture PATH with the reader options CONFIG. Throws failure. */
inline std::unique_ptr<OIIO::ImageInput>
open_picture(const std::string &path, const OIIO::ImageSpec *config = nullptr)
{
    std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create(path);

    /* The error is cleared, because another reader may support the file. */
    (void)OIIO::geterror();
    reject_video_reader(in.get());
    in = OIIO::ImageInput::open(path, config);
    if (!in)
        throw failure{GLINT_E_FORMAT, describe_open_error(OIIO::geterror())};
    reject_video_reader(in.get());
    return in;
}

/* Throws failure if glint cannot read a picture of SPEC. Called before any
 * memory is allocated. */
inline void reject_unsupported_spec(const OIIO::ImageSpec &spec)
{
    if (spec.deep || spec.nchannels < 1 || spec.depth > 1)
        throw failure{GLINT_E_UNSUPPORTED,
                      "is a deep or 3-D picture; glint reads flat ones"};
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
