/* SPDX-License-Identifier: MIT
 *
 * Checks the flux of the direct image, in units of which all light is measured:
 * at each f-number it is proportional to the number of traced rays that pass
 * the stop.
 */
#include "bake/model_header.h"
#include "support/lens_check.h"

static const double nm[3] = {650, 532, 450};

/* Sets up the lens NAME at F_NUMBER with BLADES twice: MODEL from the header of
 * its baked model, stopped down, and EXACT from its lens table. */
static void make_model_and_exact_setups(const char *name, double f_number,
                                        int blades, struct glint_setup *model,
                                        struct glint_setup *exact)
{
    static struct glint_prescription lens;
    static struct glint_setup whole;
    static struct glint_model_header header;
    const struct glint_lens file = {.header = &header};
    struct glint_bake_options options;
    struct glint_error error;

    load_lens(&lens, name);
    glint_bake_defaults(&options);
    assert_ok(glint_setup_init(&whole, &lens, 0, 0, nm, 3, &error));
    assert_ok(glint_model_set_header(&lens, &options, &whole, &header));
    header.n_ghosts = header.n_parts = 0;
    assert_ok(glint_setup_from_model(model, &file, blades, 0, nm, 3, &error));
    assert_ok(glint_setup_stop_down(model, &file, f_number, &error));
    assert_ok(glint_prescription_set_f_number(&lens, f_number, &error));
    assert_ok(glint_setup_init(exact, &lens, blades, 0, nm, 3, &error));
}

/* At full aperture, the lens barrels clip the rim of the pupil, so that the
 * flux is 1 / 1.027 and 1 / 1.10 of that through a full circle. From a quarter
 * f-stop down, they clip nothing. The interpolation over three apertures cannot
 * reproduce this kink of the flux. */
TEST(barrels_reduce_the_flux_of_fast_lenses)
{
    static const struct {
        const char *name;
        double f_number, within;
    } cases[] = {{"../tests/lenses/tronnier-double-gauss", 2, 2e-3},
                 {"../tests/lenses/tronnier-double-gauss", 2.8, 2e-3},
                 {"../tests/lenses/tronnier-double-gauss", 11, 2e-3},
                 {"../tests/lenses/merte-biotar", 1.4, 2e-3},
                 {"../tests/lenses/merte-biotar", 2, 4e-3},
                 {"../tests/lenses/merte-biotar", 4, 4e-3},
                 {"../tests/lenses/merte-biotar", 1.6, 0.025},
                 {"../tests/lenses/cooke-triplet", 5, 2e-3}};

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static struct glint_setup model, exact;

        make_model_and_exact_setups(cases[i].name, cases[i].f_number, 8, &model,
                                    &exact);
        for (int k = 0; k < 3; k++)
            assert_near(model.direct_flux[k] / exact.direct_flux[k], 1,
                        cases[i].within);
    }
}

/* Light falls off towards the rim of a fast lens, so a triangle gets more of it
 * per area than an octagon, and a circle less. Barrels that clip the corners of
 * the octagon limit the accuracy (merte-biotar). */
TEST(flux_follows_the_outline_of_the_stop)
{
    static const struct {
        const char *name;
        double f_number;
        int blades;
        double within;
    } cases[] = {{"normal/tessar-zeiss-50", 3.5, 3, 2e-4},
                 {"normal/tessar-zeiss-50", 3.5, 0, 2e-4},
                 {"normal/tessar-zeiss-50", 5.6, 3, 2e-4},
                 {"normal/double-gauss-nikkor-50", 1.4, 3, 4e-4},
                 {"normal/double-gauss-nikkor-50", 1.4, 4, 4e-4},
                 {"normal/double-gauss-nikkor-50", 1.4, 6, 4e-4},
                 {"../tests/lenses/merte-biotar", 1.4, 3, 2e-3},
                 {"../tests/lenses/merte-biotar", 1.4, 4, 6e-3},
                 {"heliar-tronnier", 16, 3, 1e-3}};

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static struct glint_setup model, exact;

        make_model_and_exact_setups(cases[i].name, cases[i].f_number,
                                    cases[i].blades, &model, &exact);
        for (int k = 0; k < 3; k++)
            assert_near(model.direct_flux[k] / exact.direct_flux[k], 1,
                        cases[i].within);
    }
}
