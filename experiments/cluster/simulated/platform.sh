#!/bin/bash
# Write the SimGrid platform NAME with HOSTS hosts h0, h1, ... on the standard output.
#   platform.sh NAME HOSTS
# A host is one processor like the one that measured the costs: 1 Gf, one operation a nanosecond. Every host has a cable
# of its own to one switch that passes all traffic at once, so that cables, and of these rank 0's, are what saturates.
# A message passes two cables, each with half of the latency.
#   switch-100g        100 Gbit/s, 1.5 us, equal hosts (InfiniBand EDR and the like)
#   ethernet-10g       10 Gbit/s, 50 us, equal hosts (Ethernet, TCP)
#   spread-100g        as switch-100g; speeds of the hosts drawn from 0.9 to 1.1 Gf
#   stragglers-100g    as switch-100g; one host of 64, not rank 0's, has half the speed
#   two-cores          one host of two processors (CORES=2): the machine of the validation; no cable
set -euo pipefail
export LC_ALL=C

name=${1:?NAME is missing} hosts=${2:?HOSTS is missing}
case $name in
switch-100g | spread-100g | stragglers-100g) bandwidth=12.5e9 latency=1.5e-6 ;;
ethernet-10g) bandwidth=1.25e9 latency=50e-6 ;;
two-cores) bandwidth=1e10 latency=1e-6 ;;
*)
    echo "platform.sh: there is no platform $name; its head lists them" >&2
    exit 1
    ;;
esac
awk -v name="$name" -v hosts="$hosts" -v bandwidth="$bandwidth" -v latency="$latency" -v cores="${CORES:-2}" 'BEGIN {
    srand(22)
    print "<?xml version=\"1.0\"?>"
    print "<!DOCTYPE platform SYSTEM \"https://simgrid.org/simgrid.dtd\">"
    print "<platform version=\"4.1\">\n<zone id=\"cluster\" routing=\"Cluster\">"
    for (i = 0; i < hosts; i++) {
        speed = 1
        if (name == "spread-100g") speed = 0.9 + 0.2 * rand()
        if (name == "stragglers-100g" && i % 64 == 32) speed = 0.5
        core = name == "two-cores" ? cores : 1
        printf "<host id=\"h%d\" speed=\"%.6fGf\" core=\"%d\"/>\n", i, speed, core
        printf "<link id=\"l%d\" bandwidth=\"%gBps\" latency=\"%gs\" sharing_policy=\"SPLITDUPLEX\"/>\n",
            i, bandwidth, latency / 2
        printf "<host_link id=\"h%d\" up=\"l%d_UP\" down=\"l%d_DOWN\"/>\n", i, i, i
    }
    print "</zone>\n</platform>"
}'
