#include "peer.povh"
global_settings { max_trace_level 2 }
camera { perspective location <.5, 1.2, -4> right x*image_width/image_height up y angle 45 look_at <0, .6, 0> }
background { rgb <.3, .4, .6> }
Sun(<-.5, .8, -.6>, <5e4, 5e4, 5e4>, .2)
#declare Chrome = texture { pigment { rgb .9 } finish { ambient .02 diffuse .1 phong .3 phong_size 60 reflection .7 } }
#declare Red = texture { pigment { rgb <1, .2, .1> } finish { ambient .1 diffuse .7 phong .2 phong_size 20 } }
#declare Green = texture { pigment { rgb <.2, .7, .2> } finish { ambient .2 diffuse .8 phong 0 } }
sphere { <0, .7, 0>, .7 texture { Chrome } }
sphere { <-1.1, .3, -.5>, .3 texture { Red } }
sphere { <1, .25, -.7>, .25 texture { Green } }
triangle { <-3, 0, 2>, <3, 0, 2>, <0, 4, 2.5> texture { Chrome } }
plane { y, 0 texture { Green } }
