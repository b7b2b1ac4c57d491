/* SPDX-License-Identifier: MIT
 *
 * Removes properties from an XMP packet in one pass. Packets come from
 * untrusted files. */
#include "oiio/keep.h"

#include <algorithm>
#include <cstring>

namespace glint
{

namespace
{

/* prefixes of the names of XMP properties that refer to pictures or a video
 * after the first picture [Ultra HDR; Motion Photo format 1.0; Apple] */
const char *const claims[] = {"hdrgm:",
                              "HDRGainMap:",
                              "GCamera:MotionPhoto",
                              "Camera:MotionPhoto",
                              "GCamera:MicroVideo",
                              "Camera:MicroVideo",
                              "GContainer:Directory",
                              "Container:Directory"};
const char orientation[] = "tiff:Orientation";

bool is_white_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/* Copies a packet to OUT without the properties in CLAIMS. */
struct cleaner {
    struct name {
        size_t at, n;
    };

    const std::string &in;
    bool upright;
    std::string out;
    size_t at = 0;
    std::vector<name> open = {}; /* names of the open elements at position AT */
    /* number of open elements when the removal of an element began, including
     * this element; removal ends when fewer are open; 0: no element is being
     * removed */
    size_t skipped_at = 0;

    bool is_claim(const name &n) const
    {
        const auto has = [&](const char *text) {
            const size_t len = std::strlen(text);

            return n.n >= len && in.compare(n.at, len, text) == 0;
        };

        for (const char *claim : claims)
            if (has(claim))
                return true;
        return upright && n.n == sizeof orientation - 1 && has(orientation);
    }

    void copy(size_t from, size_t to)
    {
        if (!skipped_at)
            out.append(in, from, to - from);
    }

    size_t end_of_name(size_t from) const
    {
        size_t to = from;

        while (to < in.size() && !is_white_space(in[to]) && in[to] != '=' &&
               in[to] != '/' && in[to] != '>' && in[to] != '<')
            to++;
        return to;
    }

    /* Copies a comment, processing instruction or similar text that ends with
     * END. */
    bool pass(const char *end)
    {
        const size_t found = in.find(end, at);

        if (found == std::string::npos)
            return false;
        copy(at, found + std::strlen(end));
        at = found + std::strlen(end);
        return true;
    }

    bool close_element()
    {
        const size_t from = at + 2, to = end_of_name(from);
        const size_t end = in.find_first_not_of(" \t\r\n", to);

        if (open.empty() || end == std::string::npos || in[end] != '>' ||
            to - from != open.back().n ||
            in.compare(from, to - from, in, open.back().at, to - from) != 0)
            return false;
        open.pop_back();
        copy(at, end + 1);
        if (open.size() < skipped_at)
            skipped_at = 0;
        at = end + 1;
        return true;
    }

    /* Copies the attribute at position AT, with the white space before it,
     * which begins at SPACE. */
    bool pass_attribute(size_t space)
    {
        const name n = {at, end_of_name(at) - at};
        size_t quote = in.find_first_not_of(" \t\r\n", n.at + n.n);

        if (n.n == 0 || quote == std::string::npos || in[quote] != '=')
            return false;
        quote = in.find_first_not_of(" \t\r\n", quote + 1);
        if (quote == std::string::npos ||
            (in[quote] != '"' && in[quote] != '\''))
            return false;
        const size_t end = in.find(in[quote], quote + 1);
        if (end == std::string::npos)
            return false;
        if (!is_claim(n))
            copy(space, end + 1);
        at = end + 1;
        return true;
    }

    bool open_element()
    {
        const name n = {at + 1, end_of_name(at + 1) - (at + 1)};

        if (n.n == 0)
            return false;
        open.push_back(n);
        if (!skipped_at && is_claim(n))
            skipped_at = open.size();
        copy(at, n.at + n.n);
        for (at = n.at + n.n; at < in.size();) {
            const size_t space = at;

            while (at < in.size() && is_white_space(in[at]))
                at++;
            const bool is_empty = in.compare(at, 2, "/>") == 0;
            if (is_empty || in[at] == '>') {
                copy(space, at + 1 + is_empty);
                at += 1 + is_empty;
                if (is_empty)
                    open.pop_back();
                if (open.size() < skipped_at)
                    skipped_at = 0;
                return true;
            }
            if (at == in.size() || !pass_attribute(space))
                return false;
        }
        return false;
    }

    bool pass_markup()
    {
        const auto is = [&](const char *text) {
            return in.compare(at, std::strlen(text), text) == 0;
        };

        return is("<!--")         ? pass("-->")
               : is("<![CDATA[") ? pass("]]>")
               : is("<!")         ? pass(">")
               : is("<?")         ? pass("?>")
               : is("</")         ? close_element()
                                  : open_element();
    }

    bool run()
    {
        while (at < in.size()) {
            const size_t next = std::min(in.find('<', at), in.size());

            copy(at, next);
            at = next;
            if (at < in.size() && !pass_markup())
                return false;
        }
        return open.empty();
    }
};

} // namespace

bool remove_xmp_claims(std::string &xmp, bool upright)
{
    bool has_claim = upright && xmp.find(orientation) != std::string::npos;

    for (const char *claim : claims)
        has_claim = has_claim || xmp.find(claim) != std::string::npos;
    if (!has_claim)
        return true;
    struct cleaner c = {xmp, upright, {}};
    const bool is_well_formed = c.run();

    xmp = is_well_formed ? c.out : "";
    return is_well_formed;
}

} // namespace glint
