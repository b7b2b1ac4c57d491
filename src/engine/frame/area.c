/* SPDX-License-Identifier: MIT */
#include "glint/area.h"

#include <math.h>

static const double degree = GLINT_PI / 180;

static double compute_max_channel_power(const struct glint_lamp *lamp)
{
    return lamp->power * fmax(lamp->rgb[0], fmax(lamp->rgb[1], lamp->rgb[2]));
}

/* Returns the number of point lights that sample LAMP, an ellipse, before the
 * limit on all lights (thinning) reduces this number. It depends on the
 * ellipse's area and on the lamp's brightness. The semi-axes of a uniform
 * ellipse are twice its RMS semi-axes. */
static double count_lamp_sample_points(const struct glint_lamp *lamp,
                                       const struct glint_area_rule *rule)
{
    const double spacing = GLINT_AREA_SPACING_PX / rule->pixels_per_tangent;
    const double area = 180 * degree * 4 * lamp->axis[0] * lamp->axis[1];
    const double share = rule->brightest > 0
                             ? compute_max_channel_power(lamp) / rule->brightest
                             : 1;

    return 1 + fmin(area / (spacing * spacing),
                    fmax(rule->most - 1, 0) * sqrt(fmin(share, 1)));
}

struct glint_area_rule glint_area_rule_of(const struct glint_lamp *lamps, int n,
                                          double pixels_per_tangent,
                                          double most, int room, int *total)
{
    struct glint_area_rule rule = {pixels_per_tangent, most, 0, 1};
    double more = 0;
    int n_wide = 0;

    for (int i = 0; i < n; i++)
        rule.brightest =
            fmax(rule.brightest, compute_max_channel_power(&lamps[i]));
    for (int i = 0; i < n; i++) {
        const double points = count_lamp_sample_points(&lamps[i], &rule);

        more += points - 1;
        /* glint_area_plan() rounds the number of points of such a lamp up. */
        n_wide += points > 1;
    }
    if (n_wide && more > room - n - n_wide)
        rule.thinning = fmax(room - n - n_wide, 0) / more;
    if (rule.thinning <= 0)
        n_wide = 0;
    *total = n + n_wide + (int)(rule.thinning * more);
    return rule;
}

/* Sets PLACE to the position of point I of a sunflower pattern in the unit
 * circle. Returns the fraction of the lamp's power that this point emits. */
static double set_sunflower_point(const struct glint_area *a, int i,
                                  double place[2])
{
    const double golden = 2.39996322972865332;
    const double weight = fmin(a->points - i, 1);
    const double r = sqrt((i + 0.5 * weight) / a->points);

    place[0] = r * cos(golden * i);
    place[1] = r * sin(golden * i);
    return weight / a->points;
}

/* Computes two corrections of a sunflower pattern of N points: the offset of
 * its centre, and the factor that spreads its points. Patterns of few points
 * are off-centre and too narrow. One point needs no correction. From one to
 * four points the factor grows to its full size. */
static void measure_sample_point_pattern(struct glint_area *a, int n)
{
    const double part = fmin((a->points - 1) / 3, 1);
    double square = 0, place[2];

    for (int i = 0; i < n; i++) {
        const double weight = set_sunflower_point(a, i, place);

        a->centre[0] += weight * place[0];
        a->centre[1] += weight * place[1];
        square += weight * (place[0] * place[0] + place[1] * place[1]);
    }
    square -= a->centre[0] * a->centre[0] + a->centre[1] * a->centre[1];
    a->spread = 1;
    if (square > 0 && part > 0)
        a->spread += part * (sqrt(0.5 / square) - 1);
}

int glint_area_plan(struct glint_area *area, const struct glint_lamp *lamp,
                    const struct glint_area_rule *rule)
{
    const double t = tan(lamp->theta_deg * degree);
    const double c = cos(lamp->turn_deg * degree);
    const double s = sin(lamp->turn_deg * degree);
    const double a = lamp->axis[0], b = lamp->axis[1];
    int n;

    *area = (struct glint_area){.lamp = *lamp, .points = 1};
    area->points += rule->thinning * (count_lamp_sample_points(lamp, rule) - 1);
    n = (int)ceil(area->points);
    if (n == 1)
        return 1;
    measure_sample_point_pattern(area, n);
    area->u = t * cos(lamp->phi_deg * degree);
    area->v = t * sin(lamp->phi_deg * degree);
    area->stretch[0] = 2 * (a * c * c + b * s * s);
    area->stretch[1] = 2 * (a - b) * c * s;
    area->stretch[2] = 2 * (a * s * s + b * c * c);
    return n;
}

/* Returns the distance between neighbouring sample points of AREA, as a
 * tangent. For a long ellipse (a tube lamp) it is at most twice that in a
 * circle of equal area; otherwise each ghost of seven points would be as wide
 * as the tube is long. From one to four points it grows continuously from 0. */
double glint_area_apart(const struct glint_area *area)
{
    const double major = 2 * area->lamp.axis[0];
    const double minor = 2 * area->lamp.axis[1];
    const double part = fmin((area->points - 1) / 3, 1);

    return part * fmin(major, 2 * sqrt(major * minor)) *
           sqrt(GLINT_PI / area->points);
}

struct glint_lamp glint_area_point(const struct glint_area *area, int i)
{
    struct glint_lamp point = area->lamp;
    double place[2], u, v;

    point.axis[0] = point.axis[1] = 0;
    if (area->points <= 1)
        return point;
    point.power *= set_sunflower_point(area, i, place);
    for (int k = 0; k < 2; k++)
        place[k] = (place[k] - area->centre[k]) * area->spread;
    u = area->u + place[0] * area->stretch[0] + place[1] * area->stretch[1];
    v = area->v + place[0] * area->stretch[1] + place[1] * area->stretch[2];
    point.theta_deg = atan(hypot(u, v)) / degree;
    point.phi_deg = atan2(v, u) / degree;
    return point;
}

void glint_area_set_round(struct glint_lamp *lamp, double tangent)
{
    lamp->axis[0] = lamp->axis[1] = tangent / sqrt(2);
    lamp->turn_deg = 0;
}
