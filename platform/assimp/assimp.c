/* SPDX-License-Identifier: MIT
 *
 * The mesh plug-in: implements assimp/assimp.h with the C interface of Open
 * Asset Import (Assimp). */
#include "assimp/assimp.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

/* State of the OBJ text that is being written. */
struct writer {
    FILE *to;
    int is_flat; /* 1: all faces are flat, so normals are not written */
    /* OBJ indices, from 1, of the first vertex, texture coordinate and normal
     * of the next mesh. */
    unsigned place, uv, normal;
};

static int are_elements_finite(const struct aiVector3D *v)
{
    return isfinite(v->x) && isfinite(v->y) && isfinite(v->z);
}

/* Writes a usemtl line with the name of material INDEX of SCENE, or with an
 * empty name. Characters that OBJ would misread become '_'. */
static void write_material_name(FILE *to, const struct aiScene *scene,
                                unsigned index)
{
    struct aiString name = {0, ""};

    if (index < scene->mNumMaterials)
        aiGetMaterialString(scene->mMaterials[index], AI_MATKEY_NAME, &name);
    if (strcmp(name.data, AI_DEFAULT_MATERIAL_NAME) == 0)
        name.data[0] = 0;
    for (char *c = name.data; *c; c++)
        if ((unsigned char)*c < ' ' || *c == '#' || *c == '\\')
            *c = '_';
    fprintf(to, "usemtl %s\n", name.data);
}

/* Returns whether FACE is a triangle; points and lines are not written. */
static int is_triangle(const struct aiFace *face)
{
    return face->mNumIndices == 3;
}

/* Returns whether the vertex normals N of FACE differ from each other, so that
 * the plane of the face does not determine them. */
static int is_smooth_face(const struct aiVector3D *n, const struct aiFace *face)
{
    for (int k = 1; n && is_triangle(face) && k < 3; k++)
        if (memcmp(&n[face->mIndices[0]], &n[face->mIndices[k]], sizeof *n))
            return 1;
    return 0;
}

/* Returns the normals of MESH, or NULL if all of its faces are flat. */
static const struct aiVector3D *get_smooth_normals(const struct writer *w,
                                                   const struct aiMesh *mesh)
{
    for (unsigned i = 0; !w->is_flat && i < mesh->mNumFaces; i++)
        if (is_smooth_face(mesh->mNormals, &mesh->mFaces[i]))
            return mesh->mNormals;
    return NULL;
}

static void write_mesh_faces(const struct writer *w, const struct aiMesh *mesh,
                             const struct aiVector3D *normals)
{
    const int has_uv = mesh->mTextureCoords[0] != NULL;

    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *const face = &mesh->mFaces[i];
        const int smooth = is_smooth_face(normals, face);

        if (!is_triangle(face))
            continue;
        fputc('f', w->to);
        for (int k = 0; k < 3; k++) {
            const unsigned at = face->mIndices[k];

            fprintf(w->to, " %u", w->place + at);
            if (has_uv)
                fprintf(w->to, "/%u", w->uv + at);
            if (smooth)
                fprintf(w->to, "%s/%u", has_uv ? "" : "/", w->normal + at);
        }
        fputc('\n', w->to);
    }
}

static void write_vertex_numbers(FILE *to, const char *word,
                                 const struct aiVector3D *v, int n)
{
    fprintf(to, "%s %.9g %.9g", word, (double)v->x, (double)v->y);
    if (n > 2)
        fprintf(to, " %.9g", (double)v->z);
    fputc('\n', to);
}

static void write_mesh_as_obj(struct writer *w, const struct aiScene *scene,
                              const struct aiMesh *mesh)
{
    static const struct aiVector3D none = {0, 0, 0};
    const struct aiVector3D *const v = mesh->mVertices;
    const struct aiVector3D *const n = get_smooth_normals(w, mesh);
    const struct aiVector3D *const t = mesh->mTextureCoords[0];

    write_material_name(w->to, scene, mesh->mMaterialIndex);
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        write_vertex_numbers(w->to, "v", &v[i], 3);
        if (t)
            write_vertex_numbers(w->to, "vt", &t[i], 2);
        if (n)
            write_vertex_numbers(w->to, "vn",
                                 are_elements_finite(&n[i]) ? &n[i] : &none, 3);
    }
    write_mesh_faces(w, mesh, n);
    w->place += mesh->mNumVertices;
    w->uv += t ? mesh->mNumVertices : 0;
    w->normal += n ? mesh->mNumVertices : 0;
}

/* Returns the reason why MESH cannot be written, or NULL. Adds the number of
 * its triangles to N. */
static const char *check_mesh(const struct aiMesh *mesh, size_t *n)
{
    for (unsigned k = 0; k < mesh->mNumVertices; k++)
        if (!are_elements_finite(&mesh->mVertices[k]) ||
            (mesh->mTextureCoords[0] &&
             !are_elements_finite(&mesh->mTextureCoords[0][k])))
            return "has coordinates that are not finite";
    for (unsigned k = 0; k < mesh->mNumFaces; k++) {
        const struct aiFace *const face = &mesh->mFaces[k];

        if (!is_triangle(face))
            continue;
        ++*n;
        for (int j = 0; j < 3; j++)
            if (face->mIndices[j] >= mesh->mNumVertices)
                return "has faces with vertex numbers out of range";
    }
    return NULL;
}

/* Returns the reason why glint rejects SCENE, or NULL if glint accepts it. */
static const char *check_scene(const struct aiScene *scene,
                               unsigned max_triangles)
{
    const char *refusal = NULL;
    size_t n = 0;

    for (unsigned i = 0; i < scene->mNumMeshes && !refusal; i++)
        refusal = check_mesh(scene->mMeshes[i], &n);
    if (!refusal && n > max_triangles)
        refusal = "has more triangles than a scene can have";
    return refusal || n ? refusal : "has no triangles";
}

/* Reads the file PATH, divides polygons into triangles, applies the transforms
 * of the file's nodes and merges equal vertices. Returns NULL, with the cause
 * in REFUSAL, if glint does not accept the mesh. */
static const struct aiScene *
import_scene(const char *path, unsigned max_triangles, const char **refusal)
{
    const struct aiScene *scene = aiImportFile(path, aiProcess_Triangulate);

    *refusal = scene ? check_scene(scene, max_triangles) : aiGetErrorString();
    if (*refusal)
        return NULL;
    scene = aiApplyPostProcessing(scene, aiProcess_PreTransformVertices |
                                             aiProcess_JoinIdenticalVertices);
    *refusal = scene ? check_scene(scene, max_triangles) : aiGetErrorString();
    return *refusal ? NULL : scene;
}

static void write_scene_as_obj(int fd, const char *path, unsigned max_triangles)
{
    const char *const end = strrchr(path, '.');
    const int is_stl = end && strcasecmp(end, ".stl") == 0;
    struct writer w = {fdopen(fd, "wb"), is_stl, 1, 1, 1};
    const struct aiScene *scene;
    const char *refusal;

    if (!w.to)
        return;
    scene = import_scene(path, max_triangles, &refusal);
    if (scene)
        fputc('m', w.to);
    else
        fprintf(w.to, "x%s", *refusal ? refusal : "cannot be read");
    for (unsigned i = 0; scene && i < scene->mNumMeshes; i++)
        write_mesh_as_obj(&w, scene, scene->mMeshes[i]);
    fclose(w.to);
}

__attribute__((visibility("default")))
const struct glint_assimp glint_assimp_face = {GLINT_ASSIMP_VERSION,
                                               write_scene_as_obj};
