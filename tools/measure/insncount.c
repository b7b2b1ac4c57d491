/* SPDX-License-Identifier: MIT
 *
 * insncount.so - a QEMU plug-in that counts the instructions of a program's
 * frames, by stage, on emulated machines. Counts are the same on every run.
 *
 *     qemu-aarch64 -plugin \
 *         ./insncount.so,frame=F,idle=G,skip=N,at=H:NAME,at=... -d plugin \
 *         PROGRAM
 *
 * A frame begins when function F is entered after G has run. Within a frame,
 * entering function H begins the stage NAME, and F itself is stage 0, "rest". A
 * function that is not listed belongs to the stage that calls it. A function
 * that continues after it has called a stage must therefore be listed, too. The
 * mean over all frames but the first N is printed. The program must have one
 * thread. A block of instructions counts for the function in which it begins.
 *
 * QEMU ships no header for plug-ins; the part of its interface that is used is
 * declared here.
 */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPORTED __attribute__((visibility("default")))

struct qemu_plugin_tb;
struct qemu_plugin_insn;
struct qemu_info;
typedef void tb_trans_fn(uint64_t id, struct qemu_plugin_tb *tb);
typedef void at_exit_fn(uint64_t id, void *ctx);

void qemu_plugin_register_vcpu_tb_trans_cb(uint64_t id, tb_trans_fn *fn);
void qemu_plugin_register_atexit_cb(uint64_t id, at_exit_fn *fn, void *ctx);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *tb);
struct qemu_plugin_insn *
qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *tb, size_t i);
const char *qemu_plugin_insn_symbol(const struct qemu_plugin_insn *insn);
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb *tb,
                                          void (*fn)(unsigned cpu, void *ctx),
                                          int flags, void *ctx);
void qemu_plugin_outs(const char *text);
int qemu_plugin_install(uint64_t id, const struct qemu_info *info, int argc,
                        char **argv);

EXPORTED int qemu_plugin_version = 1;

enum { MAX_MARKS = 32, ASLEEP = -2, IDLE = -1, REST = 0, INHERIT = -3 };

struct block {
    int n, stage; /* number of instructions in the block, and its stage: an
                   * index, ASLEEP in the idle function, or INHERIT for the
                   * stage of the caller */
};

static struct {
    const char *function, *name;
} mark[MAX_MARKS];
/* number of stage functions; mark[0] is the frame function */
static int n_marks = 1;
static const char *idle = "";
static int stage = ASLEEP, n_frames, n_skipped;
static uint64_t spent[MAX_MARKS];

static int find_stage_of_function(const char *function)
{
    if (strcmp(function, idle) == 0)
        return ASLEEP;
    for (int i = 0; i < n_marks; i++)
        if (mark[i].function && strcmp(function, mark[i].function) == 0)
            return i;
    return INHERIT;
}

static void count_block_instructions(unsigned cpu, void *ctx)
{
    const struct block *b = ctx;

    (void)cpu;
    if (b->stage == ASLEEP)
        stage = IDLE;
    else if (stage == IDLE && b->stage == REST) {
        stage = REST;
        n_frames++;
    } else if (stage >= REST && b->stage >= REST)
        stage = b->stage;
    if (stage >= REST && n_frames > n_skipped)
        spent[stage] += (uint64_t)b->n;
}

/* Prints the mean instructions of each stage. Several functions may have the
 * same stage name. */
static void print_stage_instructions(uint64_t id, void *ctx)
{
    const int n = n_frames > n_skipped ? n_frames - n_skipped : 1;
    char line[256];

    (void)id;
    (void)ctx;
    for (int i = 0; i < n_marks; i++) {
        uint64_t sum = 0;
        int first = n_marks;

        for (int k = n_marks - 1; k >= 0; k--)
            if (strcmp(mark[k].name, mark[i].name) == 0) {
                sum += spent[k];
                first = k;
            }
        if (sum && first == i) {
            snprintf(line, sizeof line, "%14llu %s\n",
                     (unsigned long long)(sum / (uint64_t)n), mark[i].name);
            qemu_plugin_outs(line);
        }
    }
    snprintf(line, sizeof line, "%14d frames\n", n_frames - n_skipped);
    qemu_plugin_outs(line);
}

static void parse_stage_mark(char *text)
{
    char *colon = strchr(text, ':');

    if (!colon || n_marks == MAX_MARKS)
        return;
    *colon = '\0';
    mark[n_marks].function = text;
    mark[n_marks++].name = colon + 1;
}

static void instrument_block(uint64_t id, struct qemu_plugin_tb *tb)
{
    const char *name = qemu_plugin_insn_symbol(qemu_plugin_tb_get_insn(tb, 0));
    /* never freed because QEMU may run the code at any time */
    struct block *b = malloc(sizeof *b);

    (void)id;
    if (!b)
        abort();
    b->n = (int)qemu_plugin_tb_n_insns(tb);
    b->stage = find_stage_of_function(name ? name : "?");
    qemu_plugin_register_vcpu_tb_exec_cb(tb, count_block_instructions, 0, b);
}

EXPORTED int qemu_plugin_install(uint64_t id, const struct qemu_info *info,
                                 int argc, char **argv)
{
    (void)info;
    mark[0].name = "rest";
    for (int i = 0; i < argc; i++) {
        char *text = strdup(argv[i]); /* never freed */
        char *value = text ? strchr(text, '=') : NULL;

        if (!value)
            return -1;
        *value++ = '\0';
        if (strcmp(text, "frame") == 0)
            mark[0].function = value;
        else if (strcmp(text, "idle") == 0)
            idle = value;
        else if (strcmp(text, "skip") == 0)
            n_skipped = atoi(value);
        else if (strcmp(text, "at") == 0)
            parse_stage_mark(value);
        else
            return -1;
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, instrument_block);
    qemu_plugin_register_atexit_cb(id, print_stage_instructions, NULL);
    return 0;
}
