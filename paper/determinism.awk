# Numbers of the paper about the same bits everywhere, from the tables of determinism.sh: \setval lines.
#   awk -v table=NAME -f interval.awk -f scientific.awk -f determinism.awk TABLE.tsv
# Of a price: the quotient with its interval, and the same in per cent more.
function put(key, text) { printf "\\setval{%s}{%s}\n", key, text }
function value(name,   f, i) {
    for (i = 1; i <= NF; i++) f[head[i]] = $i
    return value_of_fields(f, name)
}
function most(key, v) { if (!(key in largest) || v + 0 > largest[key]) largest[key] = v + 0 }
BEGIN { FS = "\t" }
NR == 1 { for (i = 1; i <= NF; i++) { head[i] = $i; at[$i] = i }; next }
table == "determinism" {
    v = value("price")
    if (!v) next
    prefix = "determinism/" ($at["machine"] == "this" ? "" : $at["machine"] "/") $at["part"]
    key = prefix "/" $at["compiler"] "/" $at["isa"] ($at["scene"] == "all" ? "" : "/" $at["scene"])
    put(key, value_tex(v))
    put(key "/more", value_tex(scaled(combine("-", v, exact(1)), 100)))
    if ($at["scene"] == "all") {
        if (!(prefix in lowest) || value_mid[v] < lowest[prefix]) lowest[prefix] = value_mid[v]
        if (!(prefix in highest) || value_mid[v] > highest[prefix]) highest[prefix] = value_mid[v]
    }
    if ($at["machine"] == "this" && $at["n"] + 0 > 0 && (!rounds || $at["n"] < rounds)) rounds = $at["n"]
}
table == "determinism-bits" {
    key = "bits/" ($at["machine"] == "this" ? "" : $at["machine"] "/") $at["film"] "-" $at["contract"]
    put(key "/frames", $at["frames"])
    put(key "/films", $at["films"])
    put(key "/most", $at["most_films"])
    put(key "/scenes", $at["scenes"])
    put(key "/counts", $at["counts"])
    put(key "/rays", $at["ray_difference"])
    put(key "/difference", scientific($at["max_difference"]))
    put(key "/share", sprintf("%.1f", 100 * $at["differing_share"]))
}
table == "films" {
    scenes++; rows += $at["n"]; emulated += $at["emulated"]; agree += $at["n"] - $at["different"]
    if (!($at["different"] + 0)) alike++
    if (scenes == 1 || $at["n"] < machines) machines = $at["n"]
    most("emulated", $at["emulated"]); most("builds", $at["n"]); most("names", $at["names"])
    most("processors", $at["processors"]); most("architectures", $at["architectures"])
    most("compilers", $at["compilers"]); most("isas", $at["isas"])
}
table == "machines" {
    other[$at["machine"]] = 1
    if ($at["other"] + 0) { cells += $at["n"]; same += $at["same"]; studies++ }
}
END {
    for (prefix in lowest) {
        put(prefix "/lowest", sprintf("%.2f", lowest[prefix]))
        put(prefix "/highest", sprintf("%.2f", highest[prefix]))
    }
    if (rounds) put("determinism/rounds", rounds)
    if (table == "films") {
        put("films/scenes", scenes); put("films/rows", rows); put("films/agree", agree); put("films/alike", alike)
        put("films/emulated", emulated); put("films/real", rows - emulated)
        for (key in largest) put("films/most/" key, largest[key])
    }
    if (table == "machines" && cells) {
        put("machines/cells", cells); put("machines/same", same); put("machines/studies", studies)
    }
}
