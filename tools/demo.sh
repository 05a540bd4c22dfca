#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The main job in one command: the firmware drives a 96-cell pack of 16 simulated bq76PL536 through a US06 cycle, faster than
# real time. Prints the summary and where the measurements lie. Installs what is missing when it may.
# Works from any directory, writes only into build/ of the tree.
set -eu
. "$(dirname "${BASH_SOURCE[0]}")/needs.sh"
need_tools
build_preset release -- packsim
scenario=ev-96s-us06
csv=build/release/$scenario.csv
cd "$root"
build/release/tools/packsim/packsim "$scenario" --csv "$csv"
echo
echo "One row per control period: $csv"
