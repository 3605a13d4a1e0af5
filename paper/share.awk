# A model of the time of a frame whose pieces have known costs, on threads that share processing units fairly.
#   Processor sharing (Kleinrock 1967): all threads that still work progress at the same rate. k of them progress
#   together at capacity(k), so each at capacity(k) / k; when one ends, the others speed up.
# The machine is set by `cores`, `logical` (processing units), `yield`, the throughput of a core whose units are all
# busy, in that of one thread alone, and `busy`, the rate of a unit while all are busy, in that while one is (1: units
# do not disturb each other).
function capacity(k,   together) {
    if (k > logical) k = logical
    # The system fills free cores first.
    together = k <= cores ? k : cores + (k - cores) * cores * (yield - 1) / (logical - cores)
    return logical > 1 ? together * (1 - (1 - busy) * (k - 1) / (logical - 1)) : together
}

# Restores the order of a heap of keys, smallest at 1, below the place i.
function sift(heap, count, i,   child, key) {
    key = heap[i]
    while ((child = 2 * i) <= count) {
        if (child < count && heap[child + 1] < heap[child]) child++
        if (heap[child] >= key) break
        heap[i] = heap[child]
        i = child
    }
    heap[i] = key
}

# The time in which threads with the loads 1..count finish; a load is the time that it takes alone. Empties the array.
function finish(load, count,   i, time, done, least) {
    for (i = int(count / 2); i >= 1; i--) sift(load, count, i)
    for (; count > 0; count--) {
        least = load[1]
        time += (least - done) * count / capacity(count)
        done = least
        load[1] = load[count]
        sift(load, count - 1, 1)
    }
    return time
}

# Loads of blocks of columns or rows, ceil(pieces / threads) in each, as in src/render/core/schedule.c; returns the
# number of blocks that are not empty.
function loads_of_blocks(cost, pieces, threads, load,   each, i, count) {
    split("", load)
    each = int((pieces + threads - 1) / threads)
    for (i = 0; i < pieces; i++) {
        count = int(i / each) + 1
        load[count] += cost[i]
    }
    return count
}
# Loads of fixed tiles: thread i has the tiles i, i + threads, ...
function loads_of_tiles(cost, pieces, threads, load,   i) {
    split("", load)
    for (i = 0; i < pieces; i++) load[i % threads + 1] += cost[i]
    return pieces < threads ? pieces : threads
}
# Loads of tiles on demand: the thread that has progressed least takes the next one. All threads progress at the same
# rate, so which one that is does not depend on the number of units, and the loads can be found before sharing.
function loads_on_demand(cost, pieces, threads, load,   i, count) {
    split("", load)
    count = pieces < threads ? pieces : threads
    for (i = 1; i <= count; i++) load[i] = cost[i - 1]
    for (i = int(count / 2); i >= 1; i--) sift(load, count, i)
    for (i = count; i < pieces; i++) {
        load[1] += cost[i]
        sift(load, count, 1)
    }
    return count
}
