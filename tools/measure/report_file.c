/* SPDX-License-Identifier: MIT */
#include "measure/report_file.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "posix/output.h"

bool report_file_folder(const char *path)
{
    struct stat st;

    return mkdir(path, 0777) == 0 ||
           (errno == EEXIST && stat(path, &st) == 0 && S_ISDIR(st.st_mode));
}

int report_file_save(const struct tool *tool, const char *folder,
                     const char *name, FILE *file, char **text,
                     const size_t *bytes)
{
    struct glint_error error = {""};
    struct glint_output out;
    enum glint_status status = GLINT_E_MEMORY;
    char path[1024];

    if (glint_memory_file_close(file) &&
        (size_t)snprintf(path, sizeof path, "%s/%s", folder, name) <
            sizeof path) {
        status = glint_output_open(&out, path, GLINT_OUTPUT_TEXT, &error);
        if (status == GLINT_OK)
            status = glint_output_finish(&out, *text, *bytes, &error);
    }
    free(*text);
    *text = NULL;
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}
