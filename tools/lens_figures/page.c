/* SPDX-License-Identifier: MIT */
#include "lens_figures/page.h"

#include <math.h>

#include "lab/plots/plot.h"
#include "lens_figures/drawing.h"

/* Width of a section in units of its own, which the page scales to a card. */
#define SECTION_PX 560

static const char style[] =
    "body{margin:0 auto;padding:1.5em;max-width:1600px;background:#f3f3f1}"
    "h1{margin:0;font-size:1.6em}h2{margin:0;font-size:1.1em}p{margin:.3em 0}"
    "main{display:grid;grid-template-columns:"
    "repeat(auto-fill,minmax(min(100%,430px),1fr));gap:1em;"
    "align-items:start;margin-top:1em}"
    "figure{margin:0;padding:.8em 1em;background:#fff;border:1px solid #ddd;"
    "font-size:1em;display:block}"
    "svg{display:block;width:100%;max-height:21em;margin:.4em 0}"
    "img{display:inline;width:32%;margin-right:1%}"
    "input,select{font:inherit;padding:.2em .4em}input{width:20em}"
    ".less{color:#666;font-size:.87em}";

static const char head[] =
    "<header><p>Sections have rays from the middle of the picture, blue, 0.7 "
    "of the "
    "way to its corner, green, and nearly all of it, red. Flares are of a "
    "lamp a quarter, half and four fifths of the way. <code>glint overlay "
    "photo.jpg -o out.jpg --lens NAME</code> looks through one.</p>\n"
    "<p hidden id=\"tools\"><input id=\"find\" type=\"search\" "
    "placeholder=\"words: zoom, zeiss, 1935, streak\"> <select id=\"by\">"
    "<option value=\"\">by name<option value=\"focal\">by focal length"
    "<option value=\"angle\">by angle<option value=\"f\">by f-number"
    "<option value=\"ghosts\">by ghosts</select> <output id=\"n\"></output>"
    "</p></header>\n<main>\n";

/* A card is found by words of its text, but not by glasses of its section. */
static const char script[] =
    "<script>\n"
    "const at=id=>document.getElementById(id),main=document.querySelector("
    "'main'),all=[...main.children];\n"
    "function show(){const words=at('find').value.toLowerCase().split(/\\s+/);"
    "let n=0;for(const c of all){const "
    "text=[...c.querySelectorAll('h2,p')].map("
    "p=>p.textContent).join(' ').toLowerCase();"
    "c.hidden=!words.every(w=>text.includes(w));n+=!c.hidden}"
    "at('n').textContent=n+' of '+all.length}\n"
    "at('find').oninput=show;at('by').onchange=()=>{const by=at('by').value;"
    "main.append(...(by?[...all].sort((a,b)=>a.dataset[by]-b.dataset[by]):all"
    "))};\n"
    "at('tools').hidden=false;show();\n"
    "</script>\n";

void page_begin(FILE *file)
{
    html_begin(file, "Lenses", style);
    fputs(head, file);
}

/* Writes what a photographer chooses a lens by. */
static void print_numbers(FILE *file, const struct page_card *card)
{
    const struct glint_prescription *lens = card->lens;

    fprintf(file, "<p>%.4g mm", card->focal_mm);
    if (fabs(card->squeeze - 1) > 1e-6)
        fprintf(file, " up and down, %.4g across",
                card->focal_mm / card->squeeze);
    fprintf(file, ", f/%.3g, ", lens->f_number);
    if (card->corner_deg < 89.5)
        fprintf(file, "%.0f&deg; from corner to corner", 2 * card->corner_deg);
    else
        fputs("180&deg; or more", file);
    fprintf(file, " of %.4g x %.4g mm, %d ghosts</p>\n", lens->film_width_mm,
            lens->film_height_mm, card->n_ghosts);
}

void page_card_begin(FILE *file, const struct page_card *card)
{
    struct lens_drawing drawing;

    fprintf(file,
            "<figure id=\"%s\" data-focal=\"%.6g\" data-angle=\"%.4g\" "
            "data-f=\"%g\" data-ghosts=\"%d\"><h2>%s</h2>\n<p>",
            card->name, card->focal_mm, card->corner_deg, card->lens->f_number,
            card->n_ghosts, card->name);
    html_text(file, card->lens->source);
    fputs("</p>\n", file);
    if (*card->lens->character) {
        fputs("<p>", file);
        html_text(file, card->lens->character);
        fputs("</p>\n", file);
    }
    print_numbers(file, card);
    drawing_defaults(&drawing, card->lens);
    drawing.spots = drawing.title = false;
    drawing.width_px = SECTION_PX;
    drawing_write(&drawing, file);
}

void page_card_end(FILE *file)
{
    fputs("</figure>\n", file);
}

void page_end(FILE *file)
{
    fprintf(file, "</main>\n%s", script);
    html_end(file);
}
