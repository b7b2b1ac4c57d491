# SPDX-License-Identifier: MIT
#
# growth.awk - from the JSON of 'glint bench --growth' to plots, both axes
# logarithmic, with lines of best fit, and a table of their slopes.
#
#   in   one case a line: lens, series, what varies, cpu_ms
#   out  dir/lights.svg, pixels.svg, ghosts.svg, edges.svg; all four in
#        dir/growth.svg; the table

function value(key, text) {
    if (!match($0, "\"" key "\": \"?[^,\"}]*"))
        return ""
    text = substr($0, RSTART, RLENGTH)
    sub(/^[^:]*: "?/, "", text)
    return text
}

BEGIN {
    n_panels = split("lights pixels ghosts edges", panel, " ")
    axis["lights"] = "lights"
    axis["pixels"] = "megapixels"
    axis["ghosts"] = "ghosts drawn"
    axis["edges"] = "thousand edges"
    label["quantum"] = ", quantum"
    label["grid"] = ", grid"
    split("#1f6fb2 #c2571a #3a8f3a #7a4fa3", colour, " ")
    width = 380; height = 300
    left = 46; right = 14; top = 64; bottom = 40 # of a panel, around the plot
}

/"series"/ {
    lens = value("lens"); series = value("series")
    p = series == "quantum" || series == "grid" ? "edges" : series
    x = value(p == "edges" ? "primitives" : p) / (p == "edges" ? 1000 : 1)
    if (p == "pixels")
        x = value("width") * value("height") / 1e6
    if (!(lens in number)) {
        number[lens] = ++n_lenses
        name[n_lenses] = lens
    }
    if (x > 0)
        add(p, lens SUBSEP series, log(x) / log(10),
            log(value("cpu_ms")) / log(10))
}

# One more point of line L in panel P.
function add(p, l, x, y,    i) {
    if (!(l in n)) {
        line[p, ++n_lines[p]] = l
        n[l] = 0
    }
    i = ++n[l]
    px[l, i] = x; py[l, i] = y
    if (!(p in x_lo)) {
        x_lo[p] = x_hi[p] = x
        y_lo[p] = y_hi[p] = y
    }
    if (x < x_lo[p]) x_lo[p] = x
    if (x > x_hi[p]) x_hi[p] = x
    if (y < y_lo[p]) y_lo[p] = y
    if (y > y_hi[p]) y_hi[p] = y
}

# Least squares: slope[L] and level[L], from[L] .. to[L]; last[L] is the slope
# between the means at the two largest x.
function fit(l,    i, sx, sy, sxx, sxy, a, b, sum, count) {
    a = b = -99
    sx = sy = sxx = sxy = 0
    from[l] = 99
    for (i = 1; i <= n[l]; i++) {
        sx += px[l, i]; sxx += px[l, i] ^ 2
        sy += py[l, i]; sxy += px[l, i] * py[l, i]
        sum[px[l, i]] += py[l, i]; count[px[l, i]]++
        if (px[l, i] > b) { a = b; b = px[l, i] }
        else if (px[l, i] > a && px[l, i] < b) a = px[l, i]
        if (px[l, i] < from[l]) from[l] = px[l, i]
    }
    to[l] = b
    slope[l] = level[l] = last[l] = 0
    if (a == -99)
        return
    slope[l] = (n[l] * sxy - sx * sy) / (n[l] * sxx - sx ^ 2)
    level[l] = (sy - slope[l] * sx) / n[l]
    last[l] = (sum[b] / count[b] - sum[a] / count[a]) / (b - a)
}

# ------------------------------------------------------------------- drawing

function text(x, y, anchor, more, words) {
    printf "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>%s</text>\n", \
        x, y, anchor, more, words >file
}

function stroke(x0, y0, x1, y1, more) {
    printf "<path d=\"M%.1f %.1fL%.1f %.1f\"%s/>\n", x0, y0, x1, y1, more >file
}

# Where a value is in the plot of panel P.
function at_x(p, x) {
    return left + (x - x_lo[p]) / (x_hi[p] - x_lo[p]) * (width - left - right)
}
function at_y(p, y,    up) {
    up = (y - y_lo[p]) / (y_hi[p] - y_lo[p])
    return height - bottom - up * (height - top - bottom)
}

# Circles, or squares; filled, or hollow.
function mark(x, y, square, hollow, ink) {
    ink = hollow ? "fill=\"#fff\" stroke=\"" ink "\"" : "fill=\"" ink "\""
    if (square)
        printf "<rect x=\"%.1f\" y=\"%.1f\" width=\"6\" height=\"6\" %s/>\n", \
            x - 3, y - 3, ink >file
    else
        printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.3\" %s/>\n", x, y, ink >file
}

# Lines at 1, 2, 5, 10 ... with their numbers.
function draw_axes(p,    e, k, t, m, words, middle) {
    split("1 2 5", m, " ")
    for (e = -3; e <= 5; e++)
        for (k = 1; k <= 3; k++) {
            t = e + log(m[k]) / log(10)
            words = m[k] * 10 ^ e ""
            if (t >= x_lo[p] && t <= x_hi[p]) {
                stroke(at_x(p, t), top, at_x(p, t), height - bottom, "")
                text(at_x(p, t), height - bottom + 14, "middle", "", words)
            }
            if (t >= y_lo[p] && t <= y_hi[p]) {
                stroke(left, at_y(p, t), width - right, at_y(p, t), "")
                text(left - 5, at_y(p, t) + 4, "end", "", words)
            }
        }
    text((left + width - right) / 2, height - 8, "middle", "", axis[p])
    middle = (top + height - bottom) / 2
    text(14, middle, "middle", \
         sprintf(" transform=\"rotate(-90 14 %.1f)\"", middle), "ms")
}

function draw_line(p, k,    l, part, ink, i, x, y, hollow, square) {
    l = line[p, k]
    split(l, part, SUBSEP)
    ink = colour[(number[part[1]] - 1) % 4 + 1]
    square = number[part[1]] % 2 == 0
    hollow = part[2] == "grid"
    stroke(at_x(p, from[l]), at_y(p, level[l] + slope[l] * from[l]), \
           at_x(p, to[l]), at_y(p, level[l] + slope[l] * to[l]), \
           sprintf(" stroke=\"%s\"%s", ink, \
                   hollow ? " stroke-dasharray=\"5 3\"" : ""))
    for (i = 1; i <= n[l]; i++)
        mark(at_x(p, px[l, i]), at_y(p, py[l, i]), square, hollow, ink)
    # two legends a row
    x = left + 6 + (k - 1) % 2 * 176
    y = 34 + int((k - 1) / 2) * 16
    mark(x, y - 4, square, hollow, ink)
    text(x + 8, y, "start", "", sprintf("%s%s: %.2f", \
         short(part[1]), label[part[2]], slope[l]))
}

# The name without what goes without saying.
function short(lens) {
    sub(/-tronnier|-angenieux|-zoom/, "", lens)
    return lens
}

function draw_panel(p,    k) {
    text(left, 15, "start", " font-weight=\"bold\"", \
         "A frame against " (p == "edges" ? p : axis[p]))
    draw_axes(p)
    for (k = 1; k <= n_lines[p]; k++)
        draw_line(p, k)
}

function open_svg(path, w, h) {
    file = path
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" " \
        "width=\"%d\" height=\"%d\" font-family=\"sans-serif\" " \
        "font-size=\"12\">\n<style>path{fill:none;stroke-width:1.3}" \
        "path:not([stroke]){stroke:#ddd;stroke-width:1}</style>\n" \
        "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n", w, h, w, h, w, h >file
}

function close_svg() {
    print "</svg>" >file
    close(file)
}

# ------------------------------------------------------------------- the end

# Room for the lines, and a little around the points.
function widen(p,    k, l, i, y) {
    for (k = 1; k <= n_lines[p]; k++) {
        l = line[p, k]
        for (i = 0; i < 2; i++) {
            y = level[l] + slope[l] * (i ? to[l] : from[l])
            if (y < y_lo[p]) y_lo[p] = y
            if (y > y_hi[p]) y_hi[p] = y
        }
    }
    x_lo[p] -= 0.05; x_hi[p] += 0.05
    y_lo[p] -= 0.06; y_hi[p] += 0.06
}

function cell(lens, series,    l) {
    l = lens SUBSEP series
    return l in n ? sprintf(" %.2f (%.2f) |", slope[l], last[l]) : " |"
}

END {
    for (k = 1; k <= n_panels; k++) {
        p = panel[k]
        if (!n_lines[p])
            continue
        for (i = 1; i <= n_lines[p]; i++)
            fit(line[p, i])
        widen(p)
        open_svg(dir "/" p ".svg", width, height)
        draw_panel(p)
        close_svg()
    }
    open_svg(dir "/growth.svg", 2 * width, 2 * height)
    for (k = 1; k <= n_panels; k++)
        if (n_lines[panel[k]]) {
            printf "<g transform=\"translate(%d %d)\">\n", (k - 1) % 2 * width, \
                int((k - 1) / 2) * height >file
            draw_panel(panel[k])
            print "</g>" >file
        }
    close_svg()
    print "| lens | lights | pixels | ghosts | edges, by quantum | edges, by grid |"
    print "|---|---|---|---|---|---|"
    for (k = 1; k <= n_lenses; k++)
        print "| " name[k] " |" cell(name[k], "lights") cell(name[k], "pixels") \
            cell(name[k], "ghosts") cell(name[k], "quantum") cell(name[k], "grid")
}
