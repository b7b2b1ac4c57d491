/* SPDX-License-Identifier: MIT
 *
 * Halves of the box of a zone, and halves of these.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "bake/fit/zone_rays.h"
#include "support/lens_check.h"
#include "support/rng.h"

static bool part_has(const struct glint_zone_part *p, double u, double v)
{
    return u >= p->u0 && u < p->u1 && v < p->top &&
           v >= p->top * glint_zone_rim(p->annulus);
}

/* However often a box is halved, each place must be in exactly one part. */
static void test_halves(void **state)
{
    enum { DEPTH = 8, PARTS = 1 << DEPTH };
    static struct glint_zone_part part[PARTS] = {{-1, 1, 1, -1, 1, 0}};
    uint32_t seed = 5;
    double area = 0;

    (void)state;
    for (int depth = 0; depth < DEPTH; depth++)
        for (int k = (1 << depth) - 1; k >= 0; k--) {
            const struct glint_zone_part whole = part[k];

            glint_zone_part_halve(&whole, depth % 2 == 0, &part[2 * k],
                                  &part[2 * k + 1]);
        }
    for (int k = 0; k < PARTS; k++) {
        assert_in_range(part[k].annulus, 0, GLINT_MAX_ANNULUS);
        area += (part[k].u1 - part[k].u0) * part[k].top *
                (1 - glint_zone_rim(part[k].annulus));
    }
    assert_near(area, 2, 1e-12);
    for (int i = 0; i < 1000; i++) {
        const double u = rng_signed(&seed), v = fabs(rng_signed(&seed));
        int found = 0;

        for (int k = 0; k < PARTS; k++)
            found += part_has(&part[k], u, v);
        assert_int_equal(found, 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_halves),
    };

    return cmocka_run_group_tests_name("zone_parts", tests, NULL, NULL);
}
