#!/bin/sh
# Makes the animations of the gallery again. Run it where `interplay` is on the path; it takes about a minute.
set -eu
cd "$(dirname "$0")"

# Makes FILE.gif from a scenario and further arguments of `interplay run`.
make() {
    file=$1
    shift
    interplay run "$@" --no-record --animate "$file.gif" > /dev/null
}

for scenario in \
    intersection/nice intersection/nash-nice left-turn/nice t-junction/bayesian-nice \
    all-way-stop/four roundabout/nice crash/side-impact lane-change/front-nice \
    lane-change/cooperative people/intersection people/high-street lane-change/among-idm lane-keeping/nice full-size/lane-change ramp-merge/game-nice \
    ramp-merge/contingency curve/lane-drop on-ramp/five narrow-passage/nice overtaking/oncoming mixed/garage \
    building/four-room-pid building/four-room-ilc building/iterative-warm-nights building/concurrent-exact \
    building/distributed building/centralised-hundred
do
    make "$(echo "$scenario" | tr / -)" "$scenario"
done
# One day says all of these.
make building-epw-weather building/epw-weather --set iterations=1
make building-model-predictive building/model-predictive --set iterations=1
make building-economic-mpc building/economic-mpc --set iterations=1
make building-clairvoyant building/model-predictive --set iterations=1 --set 'controller={kind="clairvoyant"}' \
    --set 'title="Four rooms, clairvoyant"'
