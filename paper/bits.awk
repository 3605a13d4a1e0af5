# Films of experiments/determinism.sh: how many each build makes of one scene, and how far they are from the film of the
# program as it is. Reads images.csv, then bits.csv; writes a table.
#   awk -v machine=NAME -f paper/bits.awk images.csv bits.csv
BEGIN { FS = ","; OFS = "\t" }
FNR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
FILENAME ~ /images[.]csv$/ {
    difference[$at["scene"], $at["film_hash"]] = $at["max_difference"] + 0
    share[$at["scene"], $at["film_hash"]] = $at["differing_share"] + 0
    next
}
{
    scene = $at["scene"]; rays = $at["rays_total"] + 0; key = scene SUBSEP $at["film_hash"]
    if (!(scene in expected)) expected[scene] = rays
    build = $at["film"] OFS $at["contract"]
    if (!(build in frames)) builds[++build_count] = build
    count(build, scene, key, rays)
}
function count(build, scene, key, rays,   off) {
    frames[build]++
    if (!((build, scene) in films)) scene_count[build]++
    if (!((build, key) in seen)) { seen[build, key] = 1; films[build, scene]++; total[build]++ }
    if (films[build, scene] > most[build]) most[build] = films[build, scene]
    if (!((build, scene, rays) in seen_rays)) { seen_rays[build, scene, rays] = 1; counts[build]++ }
    off = rays - expected[scene]
    if (off < 0) off = -off
    if (off / expected[scene] > ray_error[build] + 0) ray_error[build] = off / expected[scene]
    if (off > ray_difference[build] + 0) ray_difference[build] = off
    if (difference[key] > largest[build] + 0) largest[build] = difference[key]
    if (share[key] > widest[build] + 0) widest[build] = share[key]
}
END {
    print "machine", "film", "contract", "scenes", "frames", "n", "films", "most_films", "counts",
        "max_difference", "differing_share", "ray_difference", "ray_error"
    for (b = 1; b <= build_count; b++) {
        build = builds[b]
        print machine, build, scene_count[build], frames[build], frames[build], total[build], most[build],
            counts[build], largest[build] + 0, widest[build] + 0, ray_difference[build] + 0, ray_error[build] + 0
    }
}
