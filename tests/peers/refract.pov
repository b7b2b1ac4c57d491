#include "peer.povh"
global_settings { max_trace_level 6 }
camera { perspective location <0, .8, -4> right x*image_width/image_height up y angle 40 look_at <0, .6, 0> }
background { rgb <.6, .5, .3> }
Lamp(<-1, 4, -3>, <14, 14, 14>)
// Both surfaces of a ball let light through here; the terms are of the first.
#declare Glass = texture { pigment { rgbt <1, 1, 1, sqrt(.9)> } finish { ambient 0 diffuse 0 phong 0 } }
#declare Red = texture { pigment { rgb <1, .2, .1> } finish { ambient .1 diffuse .7 phong .2 phong_size 20 } }
#declare Floor = texture { pigment { rgb <.4, .6, .4> } finish { ambient .2 diffuse .8 phong 0 } }
#declare Mist = texture { pigment { rgbt <.3, .5, .9, .7> } finish { ambient .1/.3 diffuse .2/.3 phong 0 } }
#declare Clear = texture { pigment { rgbt 1 } finish { ambient 0 diffuse 0 phong 0 } }
sphere { <-.55, .6, -.6>, .5 texture { Glass } interior { ior 1.5 } no_shadow }
sphere { <.65, .6, -.6>, .5 texture { Mist } interior_texture { Clear } no_shadow }
sphere { <-.4, .5, 1>, .5 texture { Red } no_shadow }
sphere { <.9, .4, .8>, .4 texture { Red } no_shadow }
plane { y, 0 texture { Floor } no_shadow }
