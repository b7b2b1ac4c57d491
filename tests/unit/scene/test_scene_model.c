/* SPDX-License-Identifier: MIT
 *
 * Checks that each kind of damage to a baked scene file is rejected.
 */
#include "base/blob.h"
#include "support/rng.h"
#include "support/models/scene_builder.h"
#include "support/test.h"

static struct scene_file file;

static struct scene_file *make_scene_of_all_types(void)
{
    static const int32_t at[4][3] = {
        {0, 0, 0}, {4000, 0, 0}, {0, 4000, 0}, {0, 0, 4000}};
    static const int32_t uv_q16[4][2] = {{0, 0}, {65536, 0}, {0, 65536}};
    static const int32_t up_q30[3] = {0, 1 << 30, 0}, above[3] = {0, 5000, 0};
    static const int32_t normal_q30[4][3] = {
        {1 << 30}, {1 << 30}, {1 << 30}, {1 << 30}};
    static const uint32_t t[4][3] = {
        {0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
    static const uint8_t rgb[3 * 8] = {1, 2, 3};

    scene_begin_header(&file);
    scene_add_material(&file, "white");
    scene_add_texture(&file, rgb, 2, 1);
    scene_add_mesh(&file, at, uv_q16, normal_q30, 4, t, 4);
    scene_add_sphere(&file, "ball", 0, 0, 0, 3000, 1000);
    scene_add_plane(&file, "floor", 0, -500);
    scene_add_object(&file, "cup", 0, 0);
    scene_add_sun(&file, up_q30);
    scene_add_lamp(&file, above, 5000);
    return &file;
}

/* Opens scene S. Returns the error, or NULL if it is valid. */
static const char *find_scene_error(const struct scene_file *s)
{
    struct glint_scene_model model = {0};
    const char *reason = NULL;

    if (glint_scene_open(&model, s->data, s->bytes, &reason) == GLINT_OK)
        return NULL;
    assert_non_null(reason);
    /* glint_scene_open() does not change MODEL on an error */
    assert_null(model.header);
    return reason;
}

static void expect_scene_error(struct scene_file *s, const char *expected)
{
    const char *reason;

    scene_seal_checksum(s);
    reason = find_scene_error(s);
    assert_non_null(reason);
    assert_string_equal(reason, expected);
}

TEST(accepts_a_valid_scene)
{
    struct glint_scene_model m = scene_open_model(make_scene_of_all_types());

    assert_ptr_equal(m.header, file.data);
    assert_string_equal(m.object[2].name, "cup");
    assert_int_equal(glint_scene_find(&m, "floor"), 1);
    assert_int_equal(glint_scene_find(&m, "flo"), -1);
    assert_int_equal(glint_scene_find(&m, "floors"), -1);
    assert_true(m.mesh[0].uv_at && m.light[1].kind == GLINT_LIGHT_LAMP);
}

TEST(rejects_truncated_scenes)
{
    struct glint_scene_model model;
    const char *reason;

    scene_seal_checksum(make_scene_of_all_types());
    for (size_t bytes = 8; bytes < file.bytes; bytes++) {
        void *copy = malloc(bytes);

        memcpy(copy, file.data, bytes);
        assert_int_equal(glint_scene_open(&model, copy, bytes, &reason),
                         GLINT_E_FORMAT);
        assert_string_equal(reason, "the scene is truncated");
        free(copy);
    }
    file.data[20] ^= 1;
    assert_string_equal(find_scene_error(&file),
                        "the checksum is wrong: the scene is damaged");
}

/* Sets MEMBER of an intact scene to VALUE and checks that opening it fails with
 * REASON. */
#define REFUSES(member, value, reason)                 \
    (make_scene_of_all_types(), file.member = (value), \
     expect_scene_error(&file, (reason)))

TEST(rejects_invalid_headers)
{
    REFUSES(header.variant, 2,
            "the scene file is of a variant that this glint does not know");
    REFUSES(header.unit_log2, 61,
            "damaged scene: the unit of length is out of range");
    REFUSES(header.shadow, 2,
            "damaged scene: the settings of shadow, flare or background are "
            "out of range");
    REFUSES(header.highlights, 9,
            "damaged scene: the settings of shadow, flare or background are "
            "out of range");
    REFUSES(header.background_q15[1], 1,
            "damaged scene: the background's colour is out of range");
    REFUSES(
        header.n_lights, 33,
        "damaged scene: it has too many objects, lights, materials or meshes");
    REFUSES(header.name[0], 7, "the name has a control character");
    REFUSES(header.camera.kind, 3, "the scene's camera is of an unknown type");
    REFUSES(header.camera.at[2], GLINT_SCENE_SPAN,
            "the scene's camera is outside the scene's coordinate range");
    REFUSES(header.camera.axis_q30[0][1], 1 << 28,
            "the axes of the scene's camera are not orthogonal unit vectors");
    REFUSES(header.camera.tan_x_q24, 0,
            "the camera's field of view is out of range");
    REFUSES(header.camera.tan_y_q24, 1,
            "the camera's field of view is out of range");
}

TEST(rejects_invalid_lights)
{
    REFUSES(light[0].kind, 2, "damaged scene: a light is of an unknown type");
    REFUSES(light[0].name[0], 0,
            "damaged scene: a light's name is empty, unterminated or not "
            "printable");
    REFUSES(light[0].at[0], 1,
            "damaged scene: a light is too large, or outside the scene's "
            "coordinate range");
    REFUSES(light[1].radius, -1,
            "damaged scene: a light is too large, or outside the scene's "
            "coordinate range");
    REFUSES(light[0].toward_q30[0], 1 << 29,
            "damaged scene: a light's direction is not a unit vector");
    REFUSES(light[1].toward_q30[0], 1,
            "damaged scene: a light's direction is not a unit vector");
    REFUSES(light[0].rgb[2].mantissa, -(1 << 30),
            "damaged scene: a light's intensity is negative or not normalised");
}

TEST(rejects_invalid_materials)
{
    REFUSES(material[0].name[2], ' ',
            "damaged scene: a material's name is empty, unterminated or not "
            "printable");
    REFUSES(material[0].ambient_q15, 1,
            "damaged scene: a material's weights sum to more than 1");
    REFUSES(material[0].pass_q15, 32769,
            "damaged scene: a material's weight or colour is not 0 .. 1");
    REFUSES(material[0].power_q8, 255,
            "damaged scene: a material's Phong exponent or refractive index is "
            "out of range");
    REFUSES(material[0].index_q16, 0,
            "damaged scene: a material's Phong exponent or refractive index is "
            "out of range");
    REFUSES(
        material[0].texture, 1,
        "damaged scene: a material refers to a texture that does not exist");
    REFUSES(material[0].ward, 0,
            "damaged scene: a material refers to a brushed metal that does not "
            "exist");
    REFUSES(header.n_wards, 1,
            "the roughness or norm of a brushed metal is out of range");
    REFUSES(header.background, GLINT_BACKGROUND_ENVIRONMENT,
            "damaged scene: the background needs an environment, but there is "
            "none");
    REFUSES(
        header.n_environments, 17,
        "damaged scene: it has too many objects, lights, materials or meshes");
    REFUSES(
        header.n_environment_lights, 1,
        "damaged scene: it has too many objects, lights, materials or meshes");
    REFUSES(texture[0].width_log2, 13, "damaged scene: a texture is too large");
    REFUSES(texture[0].height_log2, 12,
            "damaged scene: a table lies outside the file");
}

/* Checks that a triangle grid is rejected if a list lacks a triangle or
 * contains one twice. */
TEST(rejects_wrong_grid_lists)
{
    const struct glint_scene_mesh *m = &file.mesh[0];
    uint32_t *start, *ref, cells, end;

    make_scene_of_all_types();
    cells = m->cells[0] * m->cells[1] * m->cells[2];
    start = file.data + m->start_at / 4;
    end = start[cells];
    for (uint32_t i = 0; i <= cells; i++)
        start[i] -= start[i] == end;
    expect_scene_error(
        &file,
        "damaged scene: a grid cell does not list a triangle that overlaps it");
    make_scene_of_all_types();
    ref = file.data + m->ref_at / 4;
    assert_true(start[1] > 1);
    ref[0] = ref[1];
    expect_scene_error(
        &file, "damaged scene: a grid cell lists its triangles out of order");
    make_scene_of_all_types();
    scene_seal_checksum(&file);
    assert_null(find_scene_error(&file));
}

TEST(rejects_invalid_meshes)
{
    REFUSES(
        mesh[0].radius, 2000,
        "damaged scene: a vertex is outside the bounding sphere of its mesh");
    REFUSES(mesh[0].radius, GLINT_SCENE_SPAN / 2,
            "damaged scene: a mesh is too large, or outside the scene's "
            "coordinate range");
    REFUSES(mesh[0].n_vertices, 3,
            "damaged scene: a triangle refers to a vertex that does not exist");
    REFUSES(mesh[0].n_vertices, 1 << 30,
            "damaged scene: a table lies outside the file");
    REFUSES(mesh[0].cell_log2, 1,
            "damaged scene: the grid of a mesh is outside the scene's "
            "coordinate range");
    REFUSES(mesh[0].cells[1], 0,
            "damaged scene: the grid of a mesh is outside the scene's "
            "coordinate range");
    REFUSES(mesh[0].cells[1], 257,
            "damaged scene: the grid of a mesh is outside the scene's "
            "coordinate range");
    REFUSES(
        mesh[0].start_at, file.mesh[0].start_at + 4,
        "damaged scene: the triangle lists of a grid do not begin at entry 0");
    REFUSES(
        mesh[0].n_triangles, 3,
        "damaged scene: a grid cell refers to a triangle that does not exist");
    REFUSES(mesh[0].uv_at, file.mesh[0].normal_at,
            "damaged scene: a vertex's texture coordinate is out of range");
    REFUSES(mesh[0].normal_at, file.mesh[0].vertex_at,
            "damaged scene: a vertex's normal is not a unit vector");
    make_scene_of_all_types();
    for (int i = 0; i < 63; i++)
        file.mesh[file.header.n_meshes++] = file.mesh[0];
    expect_scene_error(&file, "damaged scene: tables overlap");
}

TEST(rejects_invalid_objects)
{
    REFUSES(object[0].kind, 3,
            "damaged scene: an object is of an unknown type");
    REFUSES(
        object[0].material, 1,
        "damaged scene: an object refers to a material that does not exist");
    REFUSES(object[0].mesh, 1,
            "damaged scene: an object refers to a mesh that does not exist");
    REFUSES(object[2].mesh, 1,
            "damaged scene: an object refers to a mesh that does not exist");
    REFUSES(object[0].radius, 0,
            "damaged scene: a sphere's radius is out of range");
    REFUSES(object[1].radius, 1,
            "damaged scene: a sphere's radius is out of range");
    REFUSES(object[0].unblocked_q15, -1,
            "damaged scene: the light in an object's shadow is not 0 .. 1");
    REFUSES(object[0].unblocked_q15, 32769,
            "damaged scene: the light in an object's shadow is not 0 .. 1");
    REFUSES(object[0].catcher_q15, 1,
            "damaged scene: the shadow strength of a plane is not 0 .. 1");
    REFUSES(object[0].turn_q30[1], 1 << 24,
            "damaged scene: an object's rotation is not a unit quaternion");
    REFUSES(object[0].at[0], GLINT_SCENE_SPAN - 1000,
            "damaged scene: an object is outside the scene's coordinate range");
    make_scene_of_all_types();
    file.object[0].at[0] = GLINT_SCENE_SPAN - 1001;
    scene_open_model(&file);
}

/* Sets one word at a time to arbitrary values, with a valid checksum. Checks
 * that opening the file ends and reads nothing outside the file (ASan). */
TEST(any_word_is_rejected_or_harmless)
{
    static const uint32_t value[] = {0, 1, 0x7fffffff, 0x80000000, 0xffffffff};
    uint32_t seed = 1;

    scene_seal_checksum(make_scene_of_all_types());
    for (size_t i = 4; i < file.bytes / 4; i++)
        for (int k = 0; k < 6; k++) {
            uint32_t *copy = malloc(file.bytes);
            struct glint_scene_model model;
            const char *reason;

            memcpy(copy, file.data, file.bytes);
            copy[i] = k < 5 ? value[k] : rng_bits32(&seed);
            glint_blob_set_size_and_checksum(copy, file.bytes);
            glint_scene_open(&model, copy, file.bytes, &reason);
            free(copy);
        }
}
