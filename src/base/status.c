/* SPDX-License-Identifier: MIT */
#include "glint/status.h"

const char *glint_status_text(enum glint_status status)
{
    switch (status) {
    case GLINT_OK:
        return "ok";
    case GLINT_E_ARGUMENT:
        return "parameter out of range";
    case GLINT_E_MEMORY:
        return "not enough memory";
    case GLINT_E_FORMAT:
        return "malformed picture or stream";
    case GLINT_E_UNSUPPORTED:
        return "not supported";
    case GLINT_E_LENS:
        return "invalid lens data";
    case GLINT_E_IO:
        return "reading failed";
    case GLINT_E_OUTPUT:
        return "writing failed";
    case GLINT_E_CLOSED:
        return "the reader closed the pipe";
    case GLINT_E_DEVICE:
        return "device failed";
    }
    return "unknown status";
}
