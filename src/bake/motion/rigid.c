/* SPDX-License-Identifier: MIT */
#include "bake/motion/rigid.h"

#include <math.h>
#include <string.h>

enum { MOST_SWEEPS = 30 };

/* One Jacobi rotation: rotates rows and columns P and Q of A such that A[P][Q]
 * becomes 0; rotates the columns of V with them. */
static void apply_jacobi_rotation(double a[4][4], double v[4][4], int p, int q)
{
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t =
        (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
    const double c = 1 / sqrt(t * t + 1), s = t * c;

    for (int k = 0; k < 4; k++) {
        const double x = a[k][p], y = a[k][q];

        a[k][p] = c * x - s * y;
        a[k][q] = s * x + c * y;
    }
    for (int k = 0; k < 4; k++) {
        const double x = a[p][k], y = a[q][k], z = v[k][p], w = v[k][q];

        a[p][k] = c * x - s * y;
        a[q][k] = s * x + c * y;
        v[k][p] = c * z - s * w;
        v[k][q] = s * z + c * w;
    }
}

/* Sets VECTOR to the eigenvector of the largest eigenvalue of the symmetric
 * matrix A (overwritten), by Jacobi's method. */
static void find_largest_eigenvector(double a[4][4], double vector[4])
{
    double v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    int best = 0;

    for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
        double off = 0, all = 0;

        for (int p = 0; p < 4; p++)
            for (int q = 0; q < 4; q++) {
                all += a[p][q] * a[p][q];
                off += p == q ? 0 : a[p][q] * a[p][q];
            }
        if (off <= 1e-36 * all)
            break;
        for (int p = 0; p < 3; p++)
            for (int q = p + 1; q < 4; q++)
                if (a[p][q] * a[p][q] > 1e-40 * all)
                    apply_jacobi_rotation(a, v, p, q);
    }
    for (int k = 1; k < 4; k++)
        best = a[k][k] > a[best][best] ? k : best;
    for (int k = 0; k < 4; k++)
        vector[k] = v[k][best];
}

/* Sets the matrix R->row to the rotation of the quaternion R->turn. */
static void set_rotation_matrix(struct glint_rigid *r)
{
    const double w = r->turn[0], x = r->turn[1], y = r->turn[2], z = r->turn[3];
    const double row[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
        {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
        {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};

    memcpy(r->row, row, sizeof row);
}

/* Sets R to the rotation that maximises the sum of dot products of rotated
 * source vectors and target vectors. S: the sum of their outer products; rows
 * are the source's components, columns the target's. */
static void find_best_rotation(const double s[3][3], struct glint_rigid *r)
{
    double n[4][4] = {
        {s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2],
         s[0][1] - s[1][0]},
        {0, s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
        {0, 0, s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
        {0, 0, 0, s[2][2] - s[0][0] - s[1][1]}};
    double length = 0;

    for (int i = 1; i < 4; i++)
        for (int k = 0; k < i; k++)
            n[i][k] = n[k][i];
    find_largest_eigenvector(n, r->turn);
    for (int k = 0; k < 4; k++)
        length += r->turn[k] * r->turn[k];
    length = r->turn[0] < 0 ? -sqrt(length) : sqrt(length);
    for (int k = 0; k < 4; k++)
        r->turn[k] /= length;
    set_rotation_matrix(r);
}

/* Returns whether points with the covariance matrix C lie on a line. Then the
 * sum of the principal 2 x 2 minors of C is far below its upper bound, 1/3 of
 * the squared trace. The sum grows with the squared area that the points
 * span. */
static bool are_points_on_line(const double c[3][3])
{
    const double trace = c[0][0] + c[1][1] + c[2][2];
    const double area = c[0][0] * c[1][1] - c[0][1] * c[1][0] +
                        c[0][0] * c[2][2] - c[0][2] * c[2][0] +
                        c[1][1] * c[2][2] - c[1][2] * c[2][1];

    return !(area > GLINT_RIGID_LEAST * trace * trace);
}

bool glint_rigid_fit_points(int n, const double (*from)[3],
                            const double (*to)[3], struct glint_rigid *r)
{
    double a[3] = {0}, b[3] = {0}, s[3][3] = {{0}}, c[3][3] = {{0}}, moved[3];

    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) {
            a[k] += from[i][k] / n;
            b[k] += to[i][k] / n;
        }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) {
                s[j][k] += (from[i][j] - a[j]) * (to[i][k] - b[k]);
                c[j][k] += (from[i][j] - a[j]) * (from[i][k] - a[k]);
            }
    if (n < 3 || are_points_on_line((const double(*)[3])c))
        return false;
    find_best_rotation((const double(*)[3])s, r);
    for (int k = 0; k < 3; k++)
        r->at[k] = 0;
    glint_rigid_transform_point(r, a, moved);
    for (int k = 0; k < 3; k++)
        r->at[k] = b[k] - moved[k];
    return true;
}

void glint_rigid_set_nearest_rotation(const double row[3][3],
                                      struct glint_rigid *rigid)
{
    double s[3][3];

    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            s[j][k] = row[k][j];
    find_best_rotation((const double(*)[3])s, rigid);
}

void glint_rigid_transform_point(const struct glint_rigid *rigid,
                                 const double point[3], double to[3])
{
    for (int k = 0; k < 3; k++)
        to[k] = rigid->at[k] + rigid->row[k][0] * point[0] +
                rigid->row[k][1] * point[1] + rigid->row[k][2] * point[2];
}
