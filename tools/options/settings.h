/* SPDX-License-Identifier: MIT
 *
 * The options that set what is drawn and how, for all commands that draw.
 */
#ifndef GLINT_TOOLS_OPTIONS_SETTINGS_H
#define GLINT_TOOLS_OPTIONS_SETTINGS_H

#include "desk/front_option.h"
#include "desk/stop_option.h"
#include "options/coating.h"
#include "engine/frame/frame.h"
#include "engine/frame/quality.h"
#include "model/model_file.h"
#include "model/zoom_option.h"
#include "options/tool.h"

enum { SETTINGS_MAX_LAMPS = 1024 }; /* lamps by hand; a file may have more */

/* The origin of the integer engine's rays. */
enum settings_rays { SETTINGS_RAYS_MODEL, SETTINGS_RAYS_EXACT };

/* How the wavelengths that are drawn for all of the light are chosen. */
enum settings_waves {
    SETTINGS_WAVES_LIST,  /* wavelength_nm */
    SETTINGS_WAVES_COUNT, /* n_wavelengths of glint_spectrum() */
    SETTINGS_WAVES_AUTO   /* each ghost takes as many as it needs */
};

struct settings {
    /* Lens table; of a model only its name and film. */
    struct glint_prescription lens;
    struct model_file model; /* closed for exact rays */
    /* What is drawn on: it has to be a picture before a lens is baked for it.
     * NULL: that is not known yet. */
    const char *picture;
    enum settings_rays rays;
    double max_deg;   /* largest angle of the lamps that a model is baked for */
    double tolerance; /* tolerance that a model is baked with */
    struct glint_setup setup;
    struct coating coating;
    struct zoom_option zoom;
    double f_number;           /* 0: the table's */
    const char *f_number_from; /* "FILE:LINE" that asks for it; NULL: the
                                  command line */
    struct stop_option stop;
    double wavelength_nm[GLINT_MAX_WAVELENGTHS];
    int n_wavelengths;
    enum settings_waves waves;
    double sensor_mm[2]; /* 0: the table's film */
    bool by_lens;        /* lights come from where the lens images them */
    struct glint_projection projection; /* if by_lens; else by tangents */
    double exposure_ev, gain;
    double starburst; /* factor on the physical starburst; 0: none */
    bool starburst_asked, starburst_only, ghosts_only, veil_only;
    double veil, haze; /* shares of all light, 0 .. GLINT_MOST_VEIL together */
    struct front_option front;
    int only_ghost;
    const char *ghosts_file;  /* NULL: ghosts are as the lens gives them */
    struct glint_tint *tints; /* by that file */
    struct glint_dials dials; /* dials, but for max_lights */
    double quantum;           /* dials.irradiance_steps, in percent */
    int max_lights;           /* 0: not given */
    int area_samples_asked;   /* 0: as many as the quality takes */
    double apart_px; /* pixels; lights whose images are nearer are one */
    int tile_log2;
    double quality;    /* quality asked for, 0.5 by default */
    double budget_ms;  /* 0: none */
    double most_minsn; /* most million instructions of a plan, for one light; 0:
                          any */
    bool has_work;
    bool has_grid;    /* --grid or a quality was given */
    bool has_quality; /* --quality was */
    bool dither, has_exposure, balance;
};

/* Long options of this file, for a command's array; all from 1000 on. */
enum settings_option {
    OPT_F_NUMBER = 1000,
    OPT_COATING,
    OPT_STOP,
    OPT_STOP_MASK,
    OPT_DUST,
    OPT_FRONT_DUST,
    OPT_FRONT_MASK,
    OPT_WAVELENGTHS,
    OPT_DISPERSION,
    OPT_SENSOR,
    OPT_PROJECTION,
    OPT_EXPOSURE,
    OPT_GAIN,
    OPT_GHOST,
    OPT_GHOSTS,
    OPT_GRID,
    OPT_TILE,
    OPT_DITHER,
    OPT_QUANTUM,
    OPT_WHOLE,
    OPT_HALF,
    OPT_QUALITY,
    OPT_ERROR,
    OPT_BUDGET,
    OPT_WORK,
    OPT_RAYS,
    OPT_CULL,
    OPT_STAR_CULL,
    OPT_DIM,
    OPT_BALANCE,
    OPT_ONLY,
    OPT_STARBURST,
    OPT_VEIL,
    OPT_HAZE,
    OPT_MAX_LIGHTS,
    OPT_AREA_SAMPLES,
    OPT_APART,
    OPT_ZOOM,
    OPT_FOCUS,
    OPT_LAST
};

#define SETTINGS_OPTIONS                                             \
    {"f-number", required_argument, NULL, OPT_F_NUMBER},             \
        {"coating", required_argument, NULL, OPT_COATING},           \
        {"stop", required_argument, NULL, OPT_STOP},                 \
        {"stop-mask", required_argument, NULL, OPT_STOP_MASK},       \
        {"dust", required_argument, NULL, OPT_DUST},                 \
        {"front-dust", required_argument, NULL, OPT_FRONT_DUST},     \
        {"front-mask", required_argument, NULL, OPT_FRONT_MASK},     \
        {"wavelengths", required_argument, NULL, OPT_WAVELENGTHS},   \
        {"dispersion", required_argument, NULL, OPT_DISPERSION},     \
        {"sensor", required_argument, NULL, OPT_SENSOR},             \
        {"projection", required_argument, NULL, OPT_PROJECTION},     \
        {"exposure", required_argument, NULL, OPT_EXPOSURE},         \
        {"gain", required_argument, NULL, OPT_GAIN},                 \
        {"ghost", required_argument, NULL, OPT_GHOST},               \
        {"ghosts", required_argument, NULL, OPT_GHOSTS},             \
        {"grid", required_argument, NULL, OPT_GRID},                 \
        {"tile", required_argument, NULL, OPT_TILE},                 \
        {"dither", no_argument, NULL, OPT_DITHER},                   \
        {"quantum", required_argument, NULL, OPT_QUANTUM},           \
        {"whole", required_argument, NULL, OPT_WHOLE},               \
        {"half", no_argument, NULL, OPT_HALF},                       \
        {"quality", required_argument, NULL, OPT_QUALITY},           \
        {"error", required_argument, NULL, OPT_ERROR},               \
        {"budget", required_argument, NULL, OPT_BUDGET},             \
        {"work", required_argument, NULL, OPT_WORK},                 \
        {"rays", required_argument, NULL, OPT_RAYS},                 \
        {"cull", required_argument, NULL, OPT_CULL},                 \
        {"star-cull", required_argument, NULL, OPT_STAR_CULL},       \
        {"dim", required_argument, NULL, OPT_DIM},                   \
        {"balance", no_argument, NULL, OPT_BALANCE},                 \
        {"only", required_argument, NULL, OPT_ONLY},                 \
        {"starburst", required_argument, NULL, OPT_STARBURST},       \
        {"veil", required_argument, NULL, OPT_VEIL},                 \
        {"haze", required_argument, NULL, OPT_HAZE},                 \
        {"max-lights", required_argument, NULL, OPT_MAX_LIGHTS},     \
        {"area-samples", required_argument, NULL, OPT_AREA_SAMPLES}, \
        {"apart", required_argument, NULL, OPT_APART},               \
        ZOOM_OPTIONS(OPT_ZOOM, OPT_FOCUS)

/* The help of a command on these options. */
#define SETTINGS_HELP                                                          \
    "The lens\n"                                                               \
    "  --f-number N        stop it to f/N (default: the table's, or what the " \
    "model\n"                                                                  \
    "                      was baked for, which serves any larger "            \
    "N)\n" ZOOM_HELP COATING_HELP                                              \
    "  --stop SHAPE        circle or polygon:N[,ROT], 3 to 64 sides, the "     \
    "first\n"                                                                  \
    "                      corner at ROT degrees; then ,round:R, 0 to 1, "     \
    "from\n"                                                                   \
    "                      straight blades to a circle; ,soft:W, 0 to 1 stop " \
    "radii\n"                                                                  \
    "                      from dark to clear (default polygon:8, of "         \
    "overlay,\n"                                                               \
    "                      live and explain with round:0.2, or the circle "    \
    "of the\n"                                                                 \
    "                      table)\n"                                           \
    "  --stop-mask FILE    a picture in the stop, white where it is clear: "   \
    "the\n"                                                                    \
    "                      square about its circle, turned by ROT\n"           \
    "  --dust A[,SEED]     dust, scratches and smudges in the stop; dust "     \
    "covers A,\n"                                                              \
    "                      0 to 0.5, of it; try 0.01\n"                        \
    "  --wavelengths W     auto: of each ghost as many as it needs, 4 to 28 "  \
    "(default\n"                                                               \
    "                      of overlay, live and explain); N: so many, 1 to "   \
    "32,\n"                                                                    \
    "                      weighed to give the colours of all; or a list of "  \
    "nm,\n"                                                                    \
    "                      300 to 1100: three become R,G,B as they stand "     \
    "(else the\n"                                                              \
    "                      default: 650,532,450), any other number is "        \
    "weighted by\n"                                                            \
    "                      the CIE 1931 observer\n"                            \
    "  --sensor WxH        mm (default: the film of the table); the picture\n" \
    "                      is the largest of its shape that fits\n"            \
    "  --projection P      lens: light at a pixel comes from where this lens " \
    "\n"                                                                       \
    "                      images it, by its chief rays; tan (default): as\n"  \
    "                      behind a lens without distortion\n"                 \
    "  --ghost K           this ghost alone\n"                                 \
    "  --ghosts FILE       solo, mute, gain and tint of single ghosts, a "     \
    "line "                                                                    \
    "each;\n"                                                                  \
    "                      glint explain --save-ghosts FILE writes one\n"      \
    "  --only WHAT         ghosts | starburst | veil | all\n"                  \
    "Brightness\n"                                                             \
    "  --starburst S       light that the stop's edges diffract, S times as "  \
    "much\n"                                                                   \
    "                      as the lamp, f-number and stop give, 0 to 1000; 1 " \
    "is\n"                                                                     \
    "                      the default of overlay, live and explain, but "     \
    "with "                                                                    \
    "\n"                                                                       \
    "                      --ghost; off that of others\n"                      \
    "  --veil V            share of all light that the lens spreads over the " \
    "\n"                                                                       \
    "                      picture, its veiling glare index, 0 to 0.9\n"       \
    "                      (default 0; lenses have 0.005 to 0.05)\n"           \
    "  --haze H            share that a dirty front spreads by 1 to 10 "       \
    "degrees\n"                                                                \
    "                      (default 0)\n"                                      \
    "  --front-dust A[,SEED]  dust, scratches and smudges on the front "       \
    "element,\n"                                                               \
    "                      of which dust covers A, 0 to 0.5: haze in discs\n"  \
    "                      that the lamps light, sharper at a small stop\n"    \
    "  --front-mask FILE   a picture of what lies on it, white where it is\n"  \
    "                      clear: the square about its circle\n"               \
    "  --exposure EV       stops; all light times 2^EV (default 0)\n"          \
    "  --gain G            and times G (default 1)\n"                          \
    "  --balance           measure each wavelength by its own direct image, "  \
    "as\n"                                                                     \
    "                      a camera balanced to white behind this lens\n"

/* The help on options that give up accuracy for speed. */
#define SPEED_HELP                                                             \
    "Speed and accuracy of the integer engine\n"                               \
    "  --max-lights N      lights that are drawn (default 128): more merge, "  \
    "the\n"                                                                    \
    "                      faint ones first; of --lights auto the N "          \
    "strongest\n"                                                              \
    "                      (default 16)\n"                                     \
    "  --area-samples N    points that a lamp of visible extent is drawn as, " \
    "1 to\n"                                                                   \
    "                      4096, of the brightest lamp (default by "           \
    "--quality:\n"                                                             \
    "                      7, of a picture by itself 121); all lamps' "        \
    "together\n"                                                               \
    "                      are no more than --max-lights (a picture by "       \
    "itself:\n"                                                                \
    "                      than 512, unless that is given)\n"                  \
    "  --apart PX          lights whose images are nearer are one (default "   \
    "0.125)\n"                                                                 \
    "  --quality Q         0 to 1, or least, draft, default, high, finest: "   \
    "what\n"                                                                   \
    "                      is below, along the measured front of accuracy "    \
    "over\n"                                                                   \
    "                      time, and how exact a model is that has to be "     \
    "baked;\n"                                                                 \
    "                      exact: finest, and --rays exact\n"                  \
    "  --error PX          instead: the least of these whose outlines are "    \
    "off by\n"                                                                 \
    "                      about so many pixels at most (0.1 by default)\n"    \
    "  --budget MS         instead, of each frame: the most that takes so "    \
    "many\n"                                                                   \
    "                      milliseconds, as its plan tells\n"                  \
    "  --work N            what a frame of one light may take by its plan,\n"  \
    "                      thousand million instructions, and each further\n"  \
    "                      light a 16th of it (default 30, or any with\n"      \
    "                      --grid or --quality; 0: any); beyond, dust, "       \
    "grids,\n"                                                                 \
    "                      wavelengths and lights are fewer, with a word\n"    \
    "  --dispersion PX     with --wavelengths auto: outlines of "              \
    "neighbouring\n"                                                           \
    "                      wavelengths may be so far apart, 0.1 to 100 "       \
    "pixels,\n"                                                                \
    "                      unless their light is less than a code (default "   \
    "1); 0:\n"                                                                 \
    "                      650,532,450 for all, as of --quality draft and "    \
    "with\n"                                                                   \
    "                      --budget\n"                                         \
    "  --dim CODES         0 to 256: fainter ghosts share one "                \
    "wavelength's rays\n"                                                      \
    "  --rays R            model: the lens's baked polynomials (default);\n"   \
    "                      exact: traced for every frame\n"                    \
    "  --cull CODES        in 8 bits: what stays so many codes near black, 0 " \
    "to 16,\n"                                                                 \
    "                      may be left out, and faint ghosts are drawn "       \
    "coarser\n"                                                                \
    "                      (default 0.125)\n"                                  \
    "  --star-cull TIMES   of stars so many times CODES (default 2)\n"         \
    "  --grid N            fineness of the ray grids, 4 to 1024: ghosts get "  \
    "as\n"                                                                     \
    "                      many cells a side as their bending asks for, 8 "    \
    "to\n"                                                                     \
    "                      4 N (default 64); the exact engine: N for all "     \
    "(512)\n"                                                                  \
    "  --quantum P         by edges: a cell's irradiance is rounded to steps " \
    "of P\n"                                                                   \
    "                      percent, 0 (not) to 50 (default 1); edges "         \
    "between\n"                                                                \
    "                      cells of equal irradiance cost nothing\n"           \
    "  --whole CODES       of pictures in codes: edges across which light "    \
    "changes\n"                                                                \
    "                      by less lie on whole pixels (default 4)\n"          \
    "  --half              of pictures in codes: ghosts with half as many "    \
    "pixels\n"                                                                 \
    "                      each way; not with exact rays\n"                    \
    "  --tile N            small tiles of 8, 16, 32 or 64 pixels (default "    \
    "64)\n"                                                                    \
    "  --dither            ordered dither when writing 8 bits\n"

#define COMMON_HELP                                                           \
    "Common\n"                                                                \
    "  -j, --threads N     default: all processors; never changes a result\n" \
    "  --kernels K         c | sse41 | avx2 | neon | auto: never changes a "  \
    "result\n"                                                                \
    "  --seed N            of live -d test and synth; nothing else is "       \
    "random\n"                                                                \
    "  --json   -q   -v   --help   --help-all   --version\n"

void settings_defaults(struct settings *settings);

/* Takes OPTION if it is one of these. Returns -1, or -2 if it is none of these,
 * or an exit code. */
int settings_option(const struct tool *tool, struct settings *settings,
                    int option, const char *value);

/* Reads TEXT, "THETA,PHI[,POWER[,R,G,B[,SIZE]]]", into LAMP. Returns false if
 * it is malformed or out of range. */
bool settings_lamp(const char *text, struct glint_lamp *lamp);

/* Reads LENS, a table or a model, and prepares it. The model of a table is
 * baked if there is none yet, unless rays are exact. Returns an exit code. */
int settings_open(const struct tool *tool, struct settings *settings,
                  const char *lens);

/* Says by TEXT why the f-number of S cannot be had, and which line of a file
 * asks for it. Returns an exit code. */
int settings_refuse_stop(const struct tool *tool, const struct settings *s,
                         const char *text);

/* Zooms settings whose model is that of a zoom, as model_file_zoom().
 * GLINT_E_ARGUMENT: ERROR says why not. */
enum glint_status settings_zoom(struct settings *settings, double zoom,
                                struct glint_error *error);

/* Returns the stop of SETTINGS: where the line asks for no shape, a circle if
 * the table says so. */
struct stop_option settings_stop_shape(const struct settings *settings);

/* Stops the lens of SETTINGS, which are open and have a model, to F_NUMBER.
 * GLINT_E_ARGUMENT with ERROR: the model was not baked for so wide a stop. */
enum glint_status settings_stop(struct settings *settings, double f_number,
                                struct glint_error *error);

void settings_close(struct settings *settings);

struct glint_view settings_view(const struct settings *settings, int width,
                                int height);

/* Makes FRAME as the options say. Returns an exit code. */
int settings_frame(const struct tool *tool, const struct settings *settings,
                   struct glint_view view, struct glint_frame *frame);

/* Sets the dials of SETTINGS for QUALITY, 0 to 1; the default is 0.5. */
void settings_set_quality(struct settings *settings, double quality);

/* Sets the dials by TEXT, a quality's number or name; "exact" is the finest
 * with exact rays. Returns false for other texts. */
bool settings_take_quality(struct settings *settings, const char *text);

/* Sets BYTES by TEXT, the MiB of --memory, 1 to 1024. Returns false for other
 * texts. */
bool settings_memory(const char *text, size_t *bytes);

#define SETTINGS_MEMORY_HELP                                                  \
    "  --memory MIB        most that the flare may take, 1 to 1024; to fit, " \
    "grids\n"                                                                 \
    "                      get coarser, then rays are left out (default:\n"   \
    "                      what it needs, grids coarser from 384 on)\n"

/* Returns the factor on the physical starburst that is drawn; 0: none. */
double settings_starburst(const struct settings *settings);

/* Returns whether light is spread over the picture. */
bool settings_has_veil(const struct settings *settings);

/* Returns the factor on all light, gain * 2^EV. */
double settings_scale(const struct settings *settings);

/* Prints the report of a frame as JSON members, without braces. */
void settings_json(const struct glint_frame_report *report);

/* Writes as text how many lights there were and are drawn. */
void settings_lights_text(const struct glint_frame_report *report,
                          char text[64]);

/* Warns on standard error of lights that lie beyond the model or were merged
 * because they were too many; even with -q, if bundles are missing or the frame
 * is drawn coarser; with -v, of cells that give no light. */
void settings_warn_lights(const struct tool *tool,
                          const struct glint_frame_report *report);

#endif
