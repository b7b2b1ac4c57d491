/* SPDX-License-Identifier: MIT
 *
 * Evaluates the polynomials of a bundle along rows of a grid of rays, after
 * transfer.c has substituted angle and wavelength. Uses Horner's rule
 * (kernels/rays) for eight rays at once. Number formats are those of
 * transfer.c. */
#include "glint/transfer.h"

#include "base/q.h"
#include "kernels/rays/rays.h"
#include "lens/terms.h"

enum { RAYS = GLINT_RAYS };

/* Returns whether all terms of output KIND have odd powers of v; otherwise all
 * have even powers. Only for the auto basis. */
static int is_odd_in_v(int kind)
{
    return kind & 1 && kind < GLINT_OUT_ENERGY;
}

/* Sets OF_U to a polynomial in u for the row of rays at V_Q30. It is the sum of
 * those terms of output KIND that have odd (ODD = 1) or even (ODD = 0) powers
 * of v. */
static void set_row_polynomial_of_parity(const struct glint_transfer *t,
                                         const struct glint_horner *k, int kind,
                                         int odd, int32_t v_q30, int32_t v2_q30,
                                         int32_t *of_u)
{
    k->across(of_u, t->table[kind][odd], 2 * GLINT_TABLE_WIDTH,
              (t->degree_v[kind] - odd) / 2, v2_q30,
              t->degree_u[kind] < 8 ? 8 : GLINT_TABLE_WIDTH);
    for (int a = 0; odd && a <= t->degree_u[kind]; a++)
        of_u[a] = q_mul(of_u[a], v_q30, 30);
}

/* Sets OF_U to the polynomial in u of output KIND, along the row of rays at
 * V_Q30. */
static void set_row_polynomial(const struct glint_transfer *t,
                               const struct glint_horner *k, int kind,
                               int32_t v_q30, int32_t v2_q30, int32_t *of_u)
{
    int32_t odd[GLINT_TABLE_WIDTH];

    if (!t->whole) {
        set_row_polynomial_of_parity(t, k, kind, is_odd_in_v(kind), v_q30,
                                     v2_q30, of_u);
        return;
    }
    set_row_polynomial_of_parity(t, k, kind, 0, v_q30, v2_q30, of_u);
    if (t->degree_v[kind] == 0)
        return;
    set_row_polynomial_of_parity(t, k, kind, 1, v_q30, v2_q30, odd);
    for (int a = 0; a <= t->degree_u[kind]; a++)
        of_u[a] += odd[a];
}

/* Sets the polynomials in u of all outputs, along the row of rays at V_Q30. */
static void set_row_polynomials(const struct glint_transfer *t,
                                const struct glint_horner *k, int32_t v_q30,
                                int32_t (*of_u)[GLINT_TABLE_WIDTH])
{
    const int32_t v2_q30 = q_mul(v_q30, v_q30, 30);

    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        if (has_transfer_output(t, kind))
            set_row_polynomial(t, k, kind, v_q30, v2_q30, of_u[kind]);
}

/* Converts N values E of the energy polynomial to energies, in place: clamps
 * and scales each value, then squares it ROOTS times. */
static void convert_energy_values(const struct glint_transfer *t, int32_t *e,
                                  int n)
{
    const int32_t most = (INT32_C(1) << 29) >> t->head;

    for (int i = 0; (t->head || t->roots) && i < n; i++)
        e[i] = (e[i] < 0 ? 0 : e[i] > most ? most : e[i]) * (1 << t->head);
    for (int k = 0; k < t->roots; k++)
        for (int i = 0; i < n; i++)
            e[i] = q_mul(e[i], e[i], 29);
}

/* Computes all outputs of the rays at U_Q30 from the polynomials of their
 * row. */
static void evaluate_row_rays(const struct glint_transfer *t,
                              const struct glint_horner *k,
                              const int32_t *u_q30, int32_t (*out)[RAYS])
{
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        if (has_transfer_output(t, kind))
            k->along(out[kind], t->of_u[kind], t->degree_u[kind], u_q30, RAYS);
    if (has_transfer_output(t, GLINT_OUT_ENERGY))
        convert_energy_values(t, out[GLINT_OUT_ENERGY], RAYS);
}

void glint_transfer_ray(const struct glint_transfer *transfer, int32_t u_q30,
                        int32_t v_q30, struct glint_outputs *out)
{
    const struct glint_transfer *t = transfer;
    const int32_t v2_q30 = q_mul(v_q30, v_q30, 30);
    const struct glint_horner *k = glint_choose_horner_kernels(0);

    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        int32_t of_u[GLINT_TABLE_WIDTH];

        out->at[kind] = 0;
        if (!has_transfer_output(t, kind))
            continue;
        set_row_polynomial(t, k, kind, v_q30, v2_q30, of_u);
        k->along(&out->at[kind], of_u, t->degree_u[kind], &u_q30, 1);
    }
    convert_energy_values(t, &out->at[GLINT_OUT_ENERGY], 1);
}

void glint_transfer_rays(struct glint_transfer *transfer, int32_t v_q30,
                         const int32_t u_q30[GLINT_RAYS], int is_new,
                         int32_t out[GLINT_OUT_KINDS][GLINT_RAYS])
{
    const struct glint_horner *k = glint_choose_horner_kernels(transfer->sets);

    if (is_new)
        set_row_polynomials(transfer, k, v_q30, transfer->of_u);
    evaluate_row_rays(transfer, k, u_q30, out);
}
