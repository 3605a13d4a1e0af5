# shellcheck shell=bash
# verdict.sh - sourced by check scripts: their cases in the Test Anything Protocol. It counts them in cases, failed and
# skipped.
cases=0 failed=0 skipped=0

verdict() { # STATUS WHAT [WHY]
    cases=$((cases + 1))
    if (($1 == 0)); then
        echo "ok $cases - $2"
    else
        failed=$((failed + 1))
        echo "not ok $cases - $2"
        [[ -z ${3:-} ]] || tail -20 <<<"$3" | sed 's/^/# /'
    fi
}
equal() { # WHAT GOT WANTED
    [[ $2 == "$3" ]]
    verdict $? "$1" "got $2, not $3"
}
empty() { # WHAT TEXT: passes when the text, the list of errors, is empty
    [[ -z $2 ]]
    verdict $? "$1" "$2"
}
skip() { # WHY
    cases=$((cases + 1)) skipped=$((skipped + 1))
    echo "ok $cases # SKIP $1"
}
conclude() { # prints the numbers; the status of the script
    echo "$((cases - failed - skipped)) passed, $failed failed"
    ((failed == 0))
}
