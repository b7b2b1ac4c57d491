/* SPDX-License-Identifier: MIT */
#include "model/stop_option.h"

bool stop_option_shades(const struct stop_option *stop)
{
    return stop->iris.softness > 0 || stop->iris.dust > 0 || stop->mask_file;
}

enum glint_status stop_option_set(const struct stop_option *stop,
                                  struct glint_setup *setup,
                                  struct glint_dirt **dirt,
                                  struct glint_error *error)
{
    *dirt = NULL;
    return stop->iris.roundness > 0 || stop_option_shades(stop)
               ? glint_setup_iris(setup, &stop->iris, dirt, error)
               : GLINT_OK;
}
