#!/usr/bin/env bash
# Checks the subjects of the commits of a change: imperative, a capital letter first, no full stop, at most 72 characters.
#
#     .github/check-subjects.sh [BASE]    the commits of HEAD that BASE (default: main) does not have
#     .github/check-subjects.sh -         subjects from standard input, one a line
#
# Whether a word is a verb in the imperative is judged by its form and by a list of words with which subjects here began before.
# Exit code 1 with one line for each fault.
set -euo pipefail

MAX_CHARACTERS=72
# First words that are not verbs in the imperative.
OTHER_WORDS="a an all and another any by each every for how if in it its more most new no nobody nothing of on one only our several so some that
the their there they this those to two we what when where which who whoever why with without"

if [[ ${1:-} == - ]]; then
    subjects=$(cat)
else
    subjects=$(git log --no-merges --format=%s "${1:-main}..HEAD")
fi

faults=0
fault() {
    printf '%s: %s\n' "$2" "$1"
    faults=$((faults + 1))
}

while IFS= read -r subject; do
    [[ -n $subject ]] || continue
    first=${subject%% *}
    lower=${first,,}
    (( ${#subject} <= MAX_CHARACTERS )) || fault "$subject" "${#subject} characters, at most $MAX_CHARACTERS"
    [[ $first =~ ^[A-Z][a-z]+(-[a-z]+)?$ ]] || fault "$subject" "begins with a word in other than small letters after a capital"
    [[ $subject != *. ]] || fault "$subject" "ends with a full stop"
    if [[ " ${OTHER_WORDS//$'\n'/ } " == *" $lower "* ]]; then
        fault "$subject" "\`$first\` is not a verb"
    elif [[ $lower =~ (ed|ing)$ && ! $lower =~ ^(bring|embed|feed|need|ping|proceed|seed|shed|speed|spring|string|swing|wed)$ ]]; then
        fault "$subject" "\`$first\` is not in the imperative"
    elif [[ $lower =~ s$ && ! $lower =~ (ss|us)$ && ! $lower =~ ^(alias|bias|canvas)$ ]]; then
        fault "$subject" "\`$first\` is not in the imperative"
    fi
done <<< "$subjects"

(( faults == 0 )) || exit 1
