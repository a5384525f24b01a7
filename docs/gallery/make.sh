#!/bin/sh
# Makes the animations of the gallery again. Run it where `interplay` is on the path; it takes about a minute.
set -eu
cd "$(dirname "$0")"
for scenario in \
    intersection/nice intersection/game-friendly intersection/nash-nice left-turn/nice t-junction/bayesian-nice \
    all-way-stop/four roundabout/nice crash/side-impact lane-change/front-nice lane-change/bayesian-front-tough \
    lane-change/cooperative lane-change/among-idm lane-keeping/nice ramp-merge/game-nice ramp-merge/contingency \
    curve/lane-drop on-ramp/five narrow-passage/nice overtaking/oncoming mixed/garage building/four-room-ilc
do
    interplay run "$scenario" --no-record --animate "$(echo "$scenario" | tr / -).gif" > /dev/null
done
