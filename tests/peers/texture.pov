#include "peer.povh"
camera { perspective location <0, .2, -1.5> right x*image_width/image_height up y angle 50 look_at <0, 0, 0> }
background { rgb .1 }
Lamp(<.5, 1, -1.5>, <2, 2, 2>)
mesh2 {
    vertex_vectors { 4, <-1, -.6, 0>, <1, -.6, 0>, <1, .7, .4>, <-1, .7, .4> }
    uv_vectors { 4, <0, 0>, <1.5, 0>, <1.5, 1>, <0, 1> }
    face_indices { 2, <0, 1, 2>, <0, 2, 3> }
    uv_mapping
    texture { uv_mapping pigment { image_map { ppm "tools/examples/scenes/tiles.ppm" gamma srgb interpolate 2 } } finish { ambient .3 diffuse .7 phong 0 } }
    no_shadow
}
