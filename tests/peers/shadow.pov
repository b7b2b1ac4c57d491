#include "peer.povh"
camera { perspective location <0, 1, -4> right x*image_width/image_height up y angle 50 look_at <0, .5, 0> }
background { rgb <.02, .03, .05> }
Sun(<.6, .5, -.7>, <5e4, 4.6e4, 4e4>, .2)
Lamp(<-2, 3, -2>, <2, 3, 6>)
#declare Red = texture { pigment { rgb <1, .2, .1> } finish { ambient .1 diffuse .7 phong .2 phong_size 32 } }
#declare Blue = texture { pigment { rgb <.1, .2, .8> } finish { ambient .05 diffuse .55 phong .4 phong_size 6 } }
#declare Grey = texture { pigment { rgb .5 } finish { ambient .1 diffuse .9 phong 0 } }
sphere { <-.7, .5, 0>, .5 texture { Red } }
sphere { <.7, .7, .5>, .7 texture { Blue } }
triangle { <-2, 0, 1.5>, <1.5, 0, 2.5>, <-.5, 2, 2> texture { Red } }
plane { y, 0 texture { Grey } }
