/* SPDX-License-Identifier: MIT
 *
 * Functions shared by the parsers of scene lines: unit vectors, file names,
 * and errors of files.
 */
#include <math.h>
#include <string.h>

#include "bake/scene/describe.h"

bool glint_describe_normalise_vector(double x[3])
{
    const double largest =
        /* X is first divided by this value, as the squares of small numbers
         * would underflow. */
        fmax(fabs(x[0]), fmax(fabs(x[1]), fabs(x[2])));
    double length;

    if (!(largest > 0.0))
        return false;
    for (int i = 0; i < 3; i++)
        x[i] /= largest;
    length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int i = 0; i < 3; i++)
        x[i] /= length;
    return true;
}

void glint_describe_copy_file_name(const struct glint_word *word,
                                   char name[GLINT_FILE_BYTES])
{
    memcpy(name, word->start, (size_t)word->length);
    name[word->length] = '\0';
}

bool glint_describe_set_file_error(struct glint_describer *d,
                                   struct glint_text_place place,
                                   enum glint_status status)
{
    const struct glint_error cause = *d->error;

    d->status = status;
    return glint_text_set_error(&d->text, place, "%s",
                                cause.text[0] ? cause.text
                                              : glint_status_text(status));
}
