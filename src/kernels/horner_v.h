/* SPDX-License-Identifier: MIT
 *
 * horner_c.c in vectors: W, of W_N int32 lanes, and the operations used here
 * are those of the file that includes it.
 */

void KERNEL(glint_horner_along)(int32_t *out, const int32_t *c, int degree,
                                const int32_t *x, int fraction, int n)
{
    const struct shift shift = shift_by(fraction);

    for (int i = 0; i < n; i += W_N) {
        const struct factor by = factor_of(w_load(x + i));
        W sum = w_set(c[degree]);

        for (int k = degree - 1; k >= 0; k--)
            sum = w_add(w_times(sum, by, shift), w_set(c[k]));
        w_store(out + i, sum);
    }
}

void KERNEL(glint_horner_across)(int32_t *out, const int32_t *c, int stride,
                                 int degree, int32_t x, int fraction, int n)
{
    const struct shift shift = shift_by(fraction);
    const struct factor by = factor_of(w_set(x));

    for (int i = 0; i < n; i += W_N) {
        W sum = w_load(c + degree * stride + i);

        for (int k = degree - 1; k >= 0; k--)
            sum = w_add(w_times(sum, by, shift), w_load(c + k * stride + i));
        w_store(out + i, sum);
    }
}
