/* SPDX-License-Identifier: MIT
 *
 * frei0r_host PLUGIN WIDTHxHEIGHT INSTANCES [NAME=VALUE...] <FRAMES >OUT
 *
 * A small host of frei0r plug-ins: BGRA frames of 1/25 s are filtered by
 * INSTANCES of the plug-in at once, one thread per instance. The frames of the
 * first instance are written. Fails if another instance outputs different
 * frames. NAME@FRAME=VALUE sets a parameter before that frame. Numbers have
 * the decimal point of the locale.
 */
#include <dlfcn.h>
#include <locale.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "frei0r/abi.h"

enum { MOST = 64, WORD = 32 };

struct setting {
    char name[WORD];
    const char *value;
    int frame;
};

static struct setting setting[MOST];
static int n_settings;
static unsigned width, height;
static size_t frame_bytes, n_frames;
static unsigned char *input;
static struct f0r_plugin plugin;

/* Functions of the plug-in. dlsym() returns their addresses as object pointers,
 * which memcpy() converts. */
static void *(*construct)(unsigned, unsigned);
static void (*destruct)(void *);
static void (*plugin_info)(struct f0r_plugin *);
static void (*param_info)(struct f0r_param *, int);
static void (*set_value)(void *, void *, int);
static void (*get_value)(void *, void *, int);
static void (*update)(void *, double, const uint32_t *, uint32_t *);

static int exit_with_error(const char *text, const char *what)
{
    fprintf(stderr, "frei0r_host: %s %s\n", text, what ? what : "");
    exit(1);
}

static void find_plugin_symbol(void *library, const char *name, void *to)
{
    void *const at = dlsym(library, name);

    if (!at)
        exit_with_error("the plug-in lacks the function", name);
    memcpy(to, &at, sizeof at);
}

/* Sets a parameter of the plug-in and checks that it can be read back. */
static void set_and_verify_parameter(void *instance, const struct setting *s)
{
    struct f0r_param info;
    double number = strtod(s->value, NULL), got = -1;
    char *word = (char *)(uintptr_t)s->value, *back = NULL;
    int i = 0;

    for (;; i++) {
        if (i == plugin.n_params)
            exit_with_error("the plug-in has no parameter", s->name);
        param_info(&info, i);
        if (strcmp(info.name, s->name) == 0)
            break;
    }
    if (info.type == F0R_STRING) {
        set_value(instance, &word, i);
        get_value(instance, &back, i);
    } else {
        set_value(instance, &number, i);
        get_value(instance, &got, i);
    }
    if (info.type == F0R_STRING ? strcmp(back, word) != 0 : got != number)
        exit_with_error("the plug-in changed the value of", s->name);
}

static void *filter_frames(void *out)
{
    void *const instance = construct(width, height);

    if (!instance)
        exit_with_error("the plug-in creates no instance", NULL);
    for (size_t i = 0; i < n_frames; i++) {
        for (int k = 0; k < n_settings; k++)
            if (setting[k].frame == (int)i)
                set_and_verify_parameter(instance, &setting[k]);
        update(instance, (double)i / 25,
               (const uint32_t *)(const void *)(input + i * frame_bytes),
               (uint32_t *)(void *)((unsigned char *)out + i * frame_bytes));
    }
    destruct(instance);
    return NULL;
}

static void parse_setting_argument(const char *text)
{
    struct setting *const s = &setting[n_settings++];
    const char *const value = strchr(text, '=');

    if (!value || n_settings == MOST ||
        sscanf(text, "%31[^@=]@%d", s->name, &s->frame) < 1)
        exit_with_error("not NAME[@FRAME]=VALUE, or too many:", text);
    s->value = value + 1;
}

static void load_plugin(const char *path)
{
    void *const library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    int (*init)(void);

    if (!library)
        exit_with_error("cannot load", dlerror());
    find_plugin_symbol(library, "f0r_init", &init);
    find_plugin_symbol(library, "f0r_construct", &construct);
    find_plugin_symbol(library, "f0r_destruct", &destruct);
    find_plugin_symbol(library, "f0r_get_plugin_info", &plugin_info);
    find_plugin_symbol(library, "f0r_get_param_info", &param_info);
    find_plugin_symbol(library, "f0r_set_param_value", &set_value);
    find_plugin_symbol(library, "f0r_get_param_value", &get_value);
    find_plugin_symbol(library, "f0r_update", &update);
    if (init() != 1)
        exit_with_error("f0r_init() failed:", path);
    plugin_info(&plugin);
}

int main(int argc, char **argv)
{
    static pthread_t thread[MOST];
    static unsigned char *out[MOST];
    const int n = argc > 3 ? atoi(argv[3]) : 0;
    size_t bytes;

    if (n < 1 || n > MOST || sscanf(argv[2], "%ux%u", &width, &height) != 2)
        exit_with_error("usage: PLUGIN WIDTHxHEIGHT INSTANCES "
                        "[NAME=VALUE...]",
                        NULL);
    frame_bytes = (size_t)4 * width * height;
    input = malloc((size_t)256 << 20);
    if (!input)
        exit_with_error("out of memory", NULL);
    n_frames = fread(input, 1, (size_t)256 << 20, stdin) / frame_bytes;
    for (int i = 4; i < argc; i++)
        parse_setting_argument(argv[i]);
    /* Hosts with a user interface set the user's locale, so this host does,
     * too. */
    setlocale(LC_ALL, "");
    load_plugin(argv[1]);
    bytes = n_frames * frame_bytes;
    for (int i = 0; i < n; i++)
        if (!(out[i] = malloc(bytes)) ||
            pthread_create(&thread[i], NULL, filter_frames, out[i]) != 0)
            exit_with_error("out of memory, or no thread starts", NULL);
    for (int i = 0; i < n; i++) {
        pthread_join(thread[i], NULL);
        if (memcmp(out[0], out[i], bytes) != 0)
            exit_with_error("an instance outputs other frames", NULL);
    }
    return fwrite(out[0], 1, bytes, stdout) != bytes;
}
