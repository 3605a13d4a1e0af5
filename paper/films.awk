# Films of experiments/films.sh: one line a scene, from the rows of every machine. Reads results/films/*.csv.
#   awk -f paper/films.awk results/films/*.csv
# A value that differs from the most frequent one of its scene and version is "different". Emulated machines are counted apart.
# processors: different models of processors that ran the scene themselves, not by emulation or in WebAssembly.
BEGIN { OFS = "\t" }
# Fields of a line of CSV, whose quoted fields have no quotes inside.
function fields_of(line, out,   n, text) {
    while (line != "") {
        if (match(line, /^"[^"]*"/)) text = substr(line, 2, RLENGTH - 2)
        else { match(line, /^[^,]*/); text = substr(line, 1, RLENGTH) }
        out[++n] = text
        line = substr(line, RLENGTH + 2)
    }
    return n
}
function note(set, scene, text) {
    if ((set, scene, text) in noted) return
    noted[set, scene, text] = 1
    number[set, scene]++
}
FNR == 1 { delete at; n = fields_of($0, head); for (i = 1; i <= n; i++) at[head[i]] = i; next }
{
    fields_of($0, f)
    scene = f[at["scene"]]
    if (!(scene in rows)) scenes[++scene_count] = scene
    value = ""
    for (i = at["film_hash"]; i <= at["total_internal"]; i++) value = value " " f[i]
    rows[scene]++
    version = "version" in at ? f[at["version"]] : 1
    versions[version] = 1
    times[scene, version, value]++
    if (times[scene, version, value] > agree[scene, version]) agree[scene, version] = times[scene, version, value]
    note("films", scene, f[at["film_hash"]])
    note("values", scene, value)
    if (f[at["emulated"]] == "no" && f[at["architecture"]] !~ /^wasm/) note("processors", scene, f[at["processor"]])
    if (f[at["emulated"]] != "no") emulated[scene]++
    note("architectures", scene, f[at["architecture"]])
    note("compilers", scene, f[at["compiler"]])
    note("isas", scene, f[at["architecture"]] " " f[at["isa"]])
    note("names", scene, f[at["name"]])
}
END {
    print "scene", "n", "emulated", "names", "processors", "architectures", "compilers", "isas", "films", "values",
        "different"
    for (s = 1; s <= scene_count; s++) {
        scene = scenes[s]
        agreed = 0
        for (version in versions) agreed += agree[scene, version]
        print scene, rows[scene], emulated[scene] + 0, number["names", scene], number["processors", scene] + 0,
            number["architectures", scene], number["compilers", scene], number["isas", scene], number["films", scene],
            number["values", scene], rows[scene] - agreed
    }
}
