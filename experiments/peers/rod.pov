// rod.pov - experiments/scenes/rod.yaml for POV-Ray 3.7: the same lengths, eye, lamp, colours and highlights.
//   povray +Irod.pov +Orod.png +W800 +H600 -D -A +WT1 Declare=DEPTH=8 Declare=ADC=0
// No antialiasing, no radiosity, no photons: camera rays through pixel centres, and their secondary rays.
//
// Parameters, by Declare=NAME=VALUE:
//   DEPTH       reflections and refractions after the camera ray, as render.depth (max_trace_level counts that ray too)
//   ADC         a branch of less weight than this is pruned, as render.min_weight; 0 traces the whole tree
//   IOR_GLASS   index of the vessel, as vessel.ior
//   IOR_LIQUID  index of the liquid, as liquid.ior
//   ONE_BODY    1: a vessel filled with its own glass, one solid without any overlap; IOR_LIQUID is then ignored
//
// POV-Ray has no priorities. The liquid overlaps the glass by OVERLAP: a ray from the glass hits the liquid's surface
// first, from index IOR_GLASS to IOR_LIQUID, and then leaves the glass within the liquid, where POV-Ray does not refract
// it.
#version 3.7;

#ifndef (DEPTH)      #declare DEPTH = 4;         #end
#ifndef (ADC)        #declare ADC = 1/255;       #end
#ifndef (IOR_GLASS)  #declare IOR_GLASS = 1.5;   #end
#ifndef (IOR_LIQUID) #declare IOR_LIQUID = 1.33; #end
#ifndef (ONE_BODY)   #declare ONE_BODY = 0;      #end

#declare BASE = 0.001;              // the vessel's base, just above the ground
#declare BOTTOM = BASE + 0.1;       // of the vessel's hollow
#declare SURFACE = BASE + 2;        // of the liquid
#declare RIM = BASE + 3;
#declare OVERLAP = 0.001;
#declare HOLLOW_FROM = (ONE_BODY ? SURFACE : BOTTOM);

global_settings {
  assumed_gamma 1
  max_trace_level DEPTH + 1
  adc_bailout ADC
}

background { rgb <0.53, 0.75, 0.92> }
light_source { <4, 7, -5> rgb 1 }

// x to the right, y up, z away from the camera; 45 degrees from the lower to the upper edge.
camera {
  location <0, 2.75, -6>
  direction z/(2*tan(radians(45/2)))
  right x*image_width/image_height
  up y
  look_at <0, 1.5, 0>
}

#declare Tiles   = finish { ambient 0.1 diffuse 0.7 }
#declare Plastic = finish { ambient 0.1 diffuse 0.7 phong 0.5 phong_size 40 }
#declare Clear   = finish { ambient 0 diffuse 0 phong 0.6 phong_size 80 reflection { 0, 1 fresnel on } conserve_energy }

plane {
  y, 0
  pigment { checker rgb <0.85, 0.85, 0.85> rgb <0.25, 0.30, 0.35> scale 0.5 }
  finish { Tiles }
}

// The vessel. Its hollow extends through the rim, so that no two surfaces coincide there.
difference {
  cylinder { y*BASE, y*RIM, 1 }
  cylinder { y*HOLLOW_FROM, y*(RIM + 1), 0.9 }
  pigment { rgbt 1 }
  finish { Clear }
  interior { ior IOR_GLASS }
}

#if (!ONE_BODY)
cylinder {
  y*(BOTTOM - OVERLAP), y*SURFACE, 0.9 + OVERLAP
  pigment { rgbt 1 }
  finish { Clear }
  interior { ior IOR_LIQUID }
}
#end

// The rod: 0.25 x 3 x 0.25 around its centre.
box {
  <-0.125, -1.5, -0.125>, <0.125, 1.5, 0.125>
  translate <0.2, BASE + 2.1, 0>
  pigment { rgb <0.85, 0.15, 0.10> }
  finish { Plastic }
}
