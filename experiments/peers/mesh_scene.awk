# mesh_scene.awk - write the scene of the speed study for another program, with a mesh from `cuvette mesh -f obj`.
#   awk -v peer=povray -f experiments/peers/mesh_scene.awk mesh.obj >mesh.pov     # POV-Ray 3.7
#   awk -v peer=tachyon -f experiments/peers/mesh_scene.awk mesh.obj >mesh.dat
# Camera and light are those of scenes/soup.yaml. Numbers are passed to POV-Ray unchanged, to Tachyon with 9 decimals.
# The file is right-handed, the scene of both programs left-handed: z changes its sign, and corners their order.
$1 == "v" {
    if (!sub(/^-/, "", $4)) $4 = "-" $4
    place[vertices++] = "<" $2 "," $3 "," $4 ">"; corner[vertices] = sprintf("%.9f %.9f %.9f", $2, $3, $4)
}
$1 == "f" { face[faces++] = $2 " " $4 " " $3 }
END {
    if (peer == "tachyon") {
        print "BEGIN_SCENE\nRESOLUTION 800 600\nCAMERA\nZOOM 1.2071068\nASPECTRATIO 1.0\nANTIALIASING 0\nRAYDEPTH 1"
        print "CENTER 0.0 0.0 -3.0\nVIEWDIR 0.0 0.0 1.0\nUPDIR 0.0 1.0 0.0\nEND_CAMERA\nBACKGROUND 0.0 0.0 0.0"
        print "LIGHT CENTER 2.0 3.0 -4.0 RAD 0.001 COLOR 1.0 1.0 1.0"
        print "TEXDEF T AMBIENT 0.1 DIFFUSE 0.9 SPECULAR 0.0 OPACITY 1.0 COLOR 0.8 0.8 0.8 TEXFUNC 0"
        for (i = 0; i < faces; i++) {
            split(face[i], v, " ")
            print "TRI V0 " corner[v[1]] " V1 " corner[v[2]] " V2 " corner[v[3]] " T"
        }
        print "END_SCENE"
        exit
    }
    print "#version 3.7;\nglobal_settings{assumed_gamma 1 max_trace_level 1}\nbackground{rgb 0}"
    print "camera{location <0,0,-3> direction z*(0.5/tan(radians(22.5))) up y right x*(4/3)}"
    printf "light_source{<2,3,-4> rgb 1}\nmesh2{vertex_vectors{%d", vertices
    for (i = 0; i < vertices; i++)
        print "," place[i]
    printf "}\nface_indices{%d", faces
    for (i = 0; i < faces; i++) {
        split(face[i], v, " ")
        printf ",<%d,%d,%d>\n", v[1] - 1, v[2] - 1, v[3] - 1
    }
    print "}\npigment{rgb 0.8} finish{ambient 0.1 diffuse 0.9}}"
}
