/* SPDX-License-Identifier: MIT
 *
 * Weights of src/lamps/unclip.c. Made by make power-fit, from rendered lamps
 * and HDR panoramas.
 */
#ifndef GLINT_LAMPS_UNCLIP_WEIGHTS_H
#define GLINT_LAMPS_UNCLIP_WEIGHTS_H

#include "lamps/unclip.h"

enum { GLINT_UNCLIP_UNITS = 6 };

/* Min and max of each feature. */
static const int16_t range_q8[GLINT_UNCLIP_FEATURES][2] = {
    {357, 3138},   {1, 2968},  {-24, 585}, {7, 849},    {20, 1043},
    {34, 1364},    {47, 1717}, {67, 1903}, {102, 2030}, {-2551, -55},
    {-2295, -123}, {1, 572},   {-256, 972}};
static const int16_t unit_q10[GLINT_UNCLIP_UNITS][GLINT_UNCLIP_FEATURES + 1] = {
    {-594, 57, -279, 410, 870, 32, -236, -86, 84, 252, -103, 178, -706, 5286},
    {-167, -75, -1449, -493, -488, -193, -50, -65, 91, -52, 578, 2185, -46,
     5312},
    {344, -118, -2427, -540, -301, -128, 158, 382, 706, -288, -99, -10, 783,
     -6836},
    {110, 54, 101, 157, -1308, -639, -82, 377, 923, 28, -113, -224, -171,
     -2953},
    {-138, 31, 755, 135, 349, 258, 201, 157, -26, -551, 301, -892, -722, -3277},
    {320, -195, -624, 1301, 1615, 148, -55, 11, 181, -35, 13, 816, 80, -5000}};
static const int16_t out_q10[GLINT_UNCLIP_UNITS] = {-1461, -1572, 1623,
                                                    -1741, -1839, 1590};
static const int16_t linear_q10[GLINT_UNCLIP_FEATURES + 1] = {
    -1081, -187, -74, -1454, -1683, -1038, -540,
    -72,   382,  221, 834,   3930,  -1032, 19360};

#endif
