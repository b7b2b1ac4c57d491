/* SPDX-License-Identifier: MIT
 *
 * twin_glints WxH 0.scene [1.scene...] - highlights of scenes in double
 * precision, one text a frame, as a list that `glint overlay --lights` takes.
 */
#include <math.h>
#include <stdio.h>

#include "scenes/scene_file.h"
#include "twin/twin_highlights.h"

/* Prints what VIEW shows of the scene text PATH. Returns an exit code. */
static int print_frame(const struct tool *tool, const struct twin_view *view,
                       const char *path, int frame)
{
    struct twin_highlight found[TWIN_HIGHLIGHTS];
    struct glint_description scene;
    struct twin twin;
    int n, code = tool_scene(tool, path, &scene, NULL);

    if (code != EXIT_OK)
        return code;
    if (twin_open(&twin, &scene) != GLINT_OK) {
        glint_description_free(&scene);
        return EXIT_RUNTIME;
    }
    n = twin_highlights(&twin, view, found);
    for (int i = 0; i < n; i++)
        printf("%d,%.6f,%.6f,%.9g,%.7f,%.7f,%.7f,%.6f\n", frame, found[i].x,
               found[i].y, found[i].power, found[i].rgb[0], found[i].rgb[1],
               found[i].rgb[2], sqrt(fmax(found[i].variance, .5)));
    twin_close(&twin);
    glint_description_free(&scene);
    return n < 0 ? EXIT_RUNTIME : EXIT_OK;
}

int main(int argc, char **argv)
{
    const struct tool tool = {.name = "twin_glints", .quiet = true};
    struct twin_view view = {.samples = 1};
    int code = EXIT_OK;

    if (argc < 3 || sscanf(argv[1], "%dx%d", &view.width, &view.height) != 2 ||
        view.width < 1 || view.height < 1) {
        fputs("twin_glints: takes WxH 0.scene [1.scene...]\n", stderr);
        return EXIT_USAGE;
    }
    puts("frame,x,y,power,r,g,b,size");
    for (int i = 2; i < argc && code == EXIT_OK; i++)
        code = print_frame(&tool, &view, argv[i], i - 2);
    return code;
}
