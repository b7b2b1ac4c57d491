#include "peer.povh"
camera { perspective location <0, 1.6, -3.5> right x*image_width/image_height up y angle 45 look_at <0, .4, 0> }
background { rgb <.1, .12, .15> }
Sun(<-.4, .8, -.5>, <5e4, 4.8e4, 4.4e4>, .2)
#declare Red = texture { pigment { rgb <.9, .3, .1> } finish { ambient .1 diffuse .7 phong .2 phong_size 20 } }
#declare Grey = texture { pigment { rgb .6 } finish { ambient .1 diffuse .9 phong 0 } }
object {
    #include "ring.inc"
    scale .8
    // As a quaternion about x: the same in either hand.
    matrix <1, 0, 0, 0, cos(radians(-50)), sin(radians(-50)), 0, -sin(radians(-50)), cos(radians(-50)), 0, 0, 0>
    translate <0, .7, 0>
    texture { Red }
}
plane { y, 0 texture { Grey } }
