#include "peer.povh"
global_settings { max_trace_level 20 }
camera { perspective location <0, 1.2, -4.5> right x*image_width/image_height up y angle 40 look_at <0, .85, 0> }
background { rgb <.6, .5, .3> }
Lamp(<-1, 4, -3>, <14, 14, 14>)
#declare Dull = finish { ambient 0 diffuse 0 phong 0 }
#declare Clear = texture { pigment { rgbt 1 } finish { Dull } }
// A ball weakens light only where a ray enters it, a mesh at each surface.
#macro Glass(Pass, Index)
    texture { pigment { rgbt <1, 1, 1, Pass> } finish { Dull } } interior_texture { Clear } interior { ior Index } no_shadow
#end
#declare Red = texture { pigment { rgb <1, .2, .1> } finish { ambient .1 diffuse .7 phong .2 phong_size 20 } }
#declare Floor = texture { pigment { rgb <.4, .6, .4> } finish { ambient .2 diffuse .8 phong 0 } }
#declare Mist = texture { pigment { rgbt <.3, .5, .9, .7> } finish { ambient .1/.3 diffuse .2/.3 phong 0 } }
sphere { <-1.15, .5, 0>, .5 Glass(.9, 1.5) }
sphere { <-1.05, .5, -.1>, .25 texture { Red } no_shadow }
sphere { <0, .5, 0>, .5 Glass(.9, 1.5) }
object {
    #include "ring.inc"
    scale .3
    matrix <1, 0, 0, 0, cos(radians(-50)), sin(radians(-50)), 0, -sin(radians(-50)), cos(radians(-50)), 0, 0, 0>
    translate <0, .5, 0>
    texture { Red } no_shadow
}
sphere { <1.15, .5, 0>, .5 Glass(.9, 1.5) }
sphere { <1.2, .55, .05>, .3 Glass(.95, 1.33) }
sphere { <-.65, 1.5, .8>, .45 texture { Mist } interior_texture { Clear } no_shadow }
sphere { <-.6, 1.5, .9>, .3 texture { Red } no_shadow }
object {
    #include "box.inc"
    scale .4
    matrix <cos(radians(25)), 0, -sin(radians(25)), 0, 1, 0, sin(radians(25)), 0, cos(radians(25)), 0, 0, 0>
    translate <.6, 1.55, .8>
    texture { pigment { rgbt <1, 1, 1, .9> } finish { Dull } } interior { ior 1.2 } no_shadow
}
sphere { <.45, 1.5, .8>, .15 texture { Red } no_shadow }
sphere { <.75, 1.6, .7>, .15 Glass(.9, 1.5) }
plane { y, 0 texture { Floor } no_shadow }
