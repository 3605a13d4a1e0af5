# Judge the claims of paper/claims.tsv by the tables of a folder; tab separated, one line a claim: id, verdict, figure,
# reason, sentence.
#   awk -v tables=DIR -v numbers=FILE -f interval.awk -f claims.awk claims.tsv
# numbers: numbers.tex of the paper, for {KEY}. claims.tsv explains the predicates. Status 2 if claims.tsv is malformed.
function fail(text) {
    if (problem == "") problem = text
}
# A reason why the rows cannot decide a claim; the first one counts.
function lack(text) {
    if (missing == "") missing = text
}

# --- tables: cell_field[table, line, column] and columns[table, column]
function load(table,   file, line, field, name, count, i) {
    if (table in lines) return
    lines[table] = 0
    file = tables "/" table ".tsv"
    while ((getline line <file) > 0) {
        count = split(line, field, "\t")
        if (!(table in width)) {
            width[table] = count
            for (i = 1; i <= count; i++) {
                name[i] = field[i]
                columns[table, field[i]] = 1
                column_name[table, i] = field[i]
            }
            continue
        }
        lines[table]++
        for (i = 1; i <= count; i++) cell_field[table, lines[table], name[i]] = field[i]
    }
    close(file)
}
# The full name of a column, which may be given without the part before its last dots: depth for render.depth.
function full_name(table, short,   i, found, tail) {
    if ((table, short) in columns) return short
    for (i = 1; i <= width[table]; i++) {
        tail = "." short
        if (substr(column_name[table, i], length(column_name[table, i]) - length(tail) + 1) == tail) found = column_name[table, i]
    }
    if (found == "") lack("the rows of " study_of(table) " have no column " short)
    return found
}
function is_number(text) { return text ~ /^[-+]?[0-9]+[.]?[0-9]*([eE][-+]?[0-9]+)?$/ }
function holds(have, op, want) {
    if (is_number(have) && is_number(want)) { have += 0; want += 0 }
    else { have = have ""; want = want "" }
    if (op == "=") return have == want
    if (op == "!=") return have != want
    if (op == ">=") return have >= want
    if (op == "<=") return have <= want
    return op == ">" ? have > want : have < want
}
# Fills found[1..] with the lines of a table that meet the conditions and have rows; returns their number.
function select_lines(table, conditions, found,   part, count, i, line, op, at, fits, key, total) {
    load(table)
    if (!(table in width)) { lack("no rows of " study_of(table)); return 0 }
    count = split(conditions, part, " ")
    for (line = 1; line <= lines[table]; line++) {
        fits = 1
        for (i = 1; i <= count && fits; i++) {
            if (!match(part[i], /(!=|>=|<=|=|>|<)/)) { fail("no comparison in '" part[i] "'"); return 0 }
            op = substr(part[i], RSTART, RLENGTH)
            at = RSTART + RLENGTH
            key = full_name(table, substr(part[i], 1, RSTART - 1))
            fits = key != "" && holds(cell_field[table, line, key], op, substr(part[i], at))
        }
        if (fits && (!((table, "n") in columns) || cell_field[table, line, "n"] + 0 > 0)) found[++total] = line
    }
    if (!total) lack("no rows of " study_of(table) " with " (conditions == "" ? "any cell" : conditions))
    return total
}
function study_of(table) { sub(/-(metrics|curves|motion)$/, "", table); return table }

# Whether other processes used more than 5 % of the machine in most rows of a cell. The system counts in steps of 10 ms: a
# share that one step explains is none.
function is_disturbed(table, line,   wall) {
    wall = cell_field[table, line, "wall_s_median"] + 0
    return ((table, "others_share") in columns) && wall > 0 && cell_field[table, line, "others_share"] > 0.05 + 0.01 / wall
}
# Notes how well a cell is measured.
function weigh(table, line,   n, marked) {
    used[study_of(table)] = 1
    if (!((table, "n") in columns)) return
    n = cell_field[table, line, "n"] + 0
    marked = ((table, "marked") in columns) ? cell_field[table, line, "marked"] + 0 : 0
    if (fewest == "" || n < fewest) fewest = n
    rows_used += n + marked
    rows_bad += marked
    if ((table, "disturbed") in columns) rows_bad += cell_field[table, line, "disturbed"] + 0
    else if (is_disturbed(table, line)) rows_bad += n
}
function cell_value(table, line, column,   fields, i) {
    weigh(table, line)
    if (table ~ /^published-/) return exact(cell_field[table, line, column] + 0)
    for (i = 1; i <= width[table]; i++) fields[column_name[table, i]] = cell_field[table, line, column_name[table, i]]
    i = value_of_fields(fields, column)
    if (!i && !((table, column) in columns) && !((table, column "_median") in columns)) {
        column = full_name(table, column)
        if (column != "") i = value_of_fields(fields, column)
    }
    if (!i) lack("no value of " column " in the rows of " study_of(table))
    return i
}

# --- the numbers of the paper that are no cells: fits and images
function paper_number(key,   line, name, text) {
    if (!numbers_read) {
        numbers_read = 1
        while ((getline line <numbers) > 0)
            if (match(line, /^\\setval[{][^}]*[}]/)) {
                name = substr(line, 9, RLENGTH - 9)
                text = substr(line, RLENGTH + 2)
                # 3.0 \cdot 10^{-7}, and a number followed by its interval
                gsub(/\\ensuremath[{]/, "", text)
                sub(/^-[}]/, "-", text)
                if (match(text, /\\cdot 10\^[{]-?[0-9]+[}]/))
                    text = substr(text, 1, RSTART - 1) "e" substr(text, RSTART + 10, RLENGTH - 11)
                of_paper[name] = text
            }
        close(numbers)
    }
    if (!(key in of_paper) || !match(of_paper[key], /^-?[0-9.]+(e-?[0-9]+)?/)) {
        lack_number(key)
        return exact(0)
    }
    return exact(substr(of_paper[key], 1, RLENGTH) + 0)
}

function lack_number(key,   name, count, i) {
    count = split($at["needs"], name, " ")
    for (i = 1; i <= count; i++) {
        load(name[i])
        if (!(name[i] in width)) lack("no rows of " name[i])
    }
    lack("the rows do not give the number " key)
}

# --- the parser: rest is the text that is left
function skip() { sub(/^[ ]+/, "", rest) }
function take(pattern,   text) {
    skip()
    if (!match(rest, "^(" pattern ")")) return ""
    text = substr(rest, 1, RLENGTH)
    rest = substr(rest, RLENGTH + 1)
    return text
}
function need(pattern, what) {
    if (take(pattern) == "") { fail("expected " what " at '" substr(rest, 1, 30) "'"); rest = "" }
}
# table[conditions].column: sets reference_table, reference_column and the array chosen; returns the number of cells.
function reference(chosen,   conditions) {
    reference_table = take("[a-z][a-z0-9-]*")
    need("\\[", "[")
    if (!match(rest, /^[^]]*/)) return 0
    conditions = substr(rest, 1, RLENGTH)
    rest = substr(rest, RLENGTH + 1)
    need("\\]", "]")
    need("[.]", ".column")
    reference_column = take("\\([^)]*\\)|[A-Za-z_][A-Za-z0-9_.]*")
    gsub(/[()]/, "", reference_column)
    return select_lines(reference_table, conditions, chosen)
}
function over_cells(name,   chosen, count, i, v, result, seen, step, at) {
    need("\\(", "(")
    count = reference(chosen)
    need("\\)", ")")
    if (name == "count") {
        for (i = 1; i <= count; i++) weigh(reference_table, chosen[i])
        return exact(count)
    }
    if (name == "distinct") {
        for (i = 1; i <= count; i++) {
            weigh(reference_table, chosen[i])
            at = cell_field[reference_table, chosen[i], full_name(reference_table, reference_column)]
            if (!(at in seen)) { seen[at] = 1; v++ }
        }
        return exact(v + 0)
    }
    result = name ~ /^(rises|falls)$/ ? exact(1) : 0
    for (i = 1; i <= count; i++) {
        v = cell_value(reference_table, chosen[i], reference_column)
        if (!v) return exact(0)
        if (name ~ /^(rises|falls)$/) {
            if (i > 1) {
                step = name == "rises" ? is_below(at, v) : is_below(v, at)
                if (step == "unknown" && value_kind[result] == "exact" && value_mid[result]) result = value_new(0.5, 0, 1, "interval")
                else if (step != "unknown" && !step) result = exact(0)
            }
            at = v
        } else if (!result) result = v
        else if (name == "sum") result = combine("+", result, v)
        else result = extreme(name == "most" ? 1 : -1, result, v)
    }
    return result ? result : exact(0)
}
function factor(   text, v, chosen) {
    if ((text = take("[0-9]+([.][0-9]+)?(e-?[0-9]+)?")) != "") return exact(text + 0)
    if (take("-") != "") return combine("-", exact(0), factor())
    if (take("\\(") != "") { v = expression(); need("\\)", ")"); return v }
    if ((text = take("[{][^}]*[}]")) != "") return paper_number(substr(text, 2, length(text) - 2))
    skip()
    if (match(rest, /^(least|most|sum|count|distinct|rises|falls)[(]/)) return over_cells(take("[a-z]+"))
    if (!match(rest, /^[a-z][a-z0-9-]*\[/)) { fail("expected a value at '" substr(rest, 1, 30) "'"); rest = ""; return exact(0) }
    v = reference(chosen)
    if (v > 1) fail(v " cells match where one is expected: " reference_table)
    if (v < 1) return exact(0)
    v = cell_value(reference_table, chosen[1], reference_column)
    return v ? v : exact(0)
}
function product(   v, op) {
    v = factor()
    while ((op = take("[*/]")) != "") v = combine(op, v, factor())
    return v
}
function expression(   v, op) {
    v = product()
    while ((op = take("[-+]")) != "") v = combine(op, v, product())
    return v
}
function comparison(   a, b, op, r, result) {
    a = expression()
    op = take("<=|>=|<|>|=|~")
    if (op == "") { fail("expected a comparison at '" substr(rest, 1, 30) "'"); return 0 }
    b = expression()
    figure = figure (figure == "" ? "" : "; ") value_text(a) ($at["unit"] == "-" ? "" : " " $at["unit"])
    if (op == "<" || op == "<=") return is_below(a, b, op == "<=")
    if (op == ">" || op == ">=") return is_below(b, a, op == ">=")
    if (op == "=") {
        if (joint_kind(a, b) == "exact") return value_mid[a] == value_mid[b]
        return is_below(a, b) == 1 || is_below(b, a) == 1 ? 0 : "unknown"
    }
    r = combine("/", a, b)
    if (is_below(r, exact(1 - tolerance)) == 1 || is_below(exact(1 + tolerance), r) == 1) return 0
    result = is_below(exact(1 - tolerance), r, 1)
    return result == 1 && is_below(r, exact(1 + tolerance), 1) == 1 ? 1 : "unknown"
}
# Conditions joined by "and": false if one is, unknown if one is and none is false.
function predicate(text,   all, one) {
    rest = text
    all = 1
    do {
        one = comparison()
        if (one == "unknown") { if (all != 0) all = one }
        else if (!one) all = 0
    } while (problem == "" && take("and ") != "")
    skip()
    if (rest != "" && problem == "") fail("unexpected '" substr(rest, 1, 30) "'")
    return all
}

function environments_differ(   s, first, differ) {
    for (s in used) if (s in environment) {
        if (first != "" && environment[s] != first) differ = 1
        first = environment[s]
    }
    return differ
}
# A number of the paper depends on all cells of its study.
function weigh_studies(names,   name, count, i, line) {
    count = split(names, name, " ")
    for (i = 1; i <= count; i++) {
        if (name[i] in used) continue
        load(name[i])
        for (line = 1; line <= lines[name[i]]; line++)
            if (cell_field[name[i], line, "n"] + 0 > 0) weigh(name[i], line)
    }
}
# One claim. `-` as predicate: no rows say anything about it, and `needs` is the command that does.
function judge(   result, verdict, reason) {
    problem = missing = figure = reason = fewest = ""
    rows_used = rows_bad = 0
    split("", used)
    tolerance = $at["tolerance"] + 0
    if ($at["predicate"] == "-") {
        print $at["id"], "underpowered", "-", "no rows say it; run " $at["needs"], $at["sentence"]
        return
    }
    result = predicate($at["predicate"])
    if ($at["predicate"] ~ /[{]/) weigh_studies($at["needs"])
    if (problem != "" && missing == "") {
        printf "%s: claim %s: %s\n", FILENAME, $at["id"], problem >"/dev/stderr"
        malformed = 1
        return
    }
    verdict = "underpowered"
    if (missing != "") { reason = missing; figure = "-" }
    else if (fewest != "" && fewest < $at["rows"] + 0) reason = fewest " rows of a cell, " $at["rows"] " are needed"
    else if (rows_used && rows_bad / rows_used > $at["disturbed"] + 0)
        reason = sprintf("%.0f %% of the rows are disturbed or marked, at most %.0f %% may be", rows_bad / rows_used * 100, $at["disturbed"] * 100)
    else if (environments_differ() && $at["disturbed"] < 1) reason = "its studies were measured in different environments"
    else if (result == "unknown") reason = "the interval is too wide to decide"
    else verdict = result ? "reproduced" : "not reproduced"
    print $at["id"], verdict, figure, reason == "" ? "-" : reason, $at["sentence"]
}

BEGIN {
    FS = OFS = "\t"
    while ((getline line <(tables "/../environments")) > 0) {
        split(line, part, "\t")
        environment[part[1]] = part[2]
    }
}
/^#/ || /^$/ { next }
!started { for (i = 1; i <= NF; i++) at[$i] = i; started = 1; next }
NF != started_fields && started_fields { printf "%s: %s has %d fields, not %d\n", FILENAME, $1, NF, started_fields >"/dev/stderr"; malformed = 1; next }
{ started_fields = NF; judge() }
END { if (malformed) exit 2 }
