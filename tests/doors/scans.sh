#!/usr/bin/env bash
# I have scans: from STL to a map that VTK opens, and to the page.
#
#   scans.sh [--without-root] [--keep]
#
# With IST_DATA_DIR also on real scans. --keep leaves the root as the door left it.
# shellcheck source=tests/doors/door.sh
source "$(dirname "$0")/door.sh"
door scans "$@"
needs_here python:vtk python:numpy
packages
installs "the command, as docs/building.md says" "$(block docs/building.md line 'libist0_*.deb ./ist_')"
by_page README.md "ist occlusion upper_jaw.stl"

installs "VTK for Python, as docs/occlusion.md names it" "apt-get install python3-vtk9 python3-numpy"
cp "$here/open_map.py" "$walk"
types "the map, opened by vtkXMLPolyDataReader" "/usr/bin/python3 open_map.py bite.vtp"

writes docs/haptics.md closing.toml
by_page_alone docs/viewer.md "ist view upper_jaw.stl"
opened() {
  local tool
  for tool in node chromium; do command -v $tool >/dev/null || lacks "needs $tool to open the page: $install"; done
  [ -e "$source/src/viewer/node_modules/playwright-core" ] || lacks "needs the page's packages to open it: scripts/viewer.sh brings them"
  node "$here/open_page.mjs" "$walk/jaws.html" "$walk/bite.html" "$walk/run.html"
}
step "the pages, opened in Chromium" opened

if [ -e "${IST_DATA_DIR:=$source/../shared/data}/human_maxilla.stl" ]; then
  cp "$IST_DATA_DIR"/human_{maxilla,mandible}.stl "$walk"
  types "real scans, to a map and to the page" \
    "ist occlusion human_maxilla.stl human_mandible.stl --move 0,0,-0.6 --unit mm -o human.vtp -o human.html -o human.csv
/usr/bin/python3 open_map.py human.vtp"
  step "the page of real scans, opened in Chromium" node "$here/open_page.mjs" "$walk/human.html"
else
  echo "   no real scans: IST_DATA_DIR names no folder that has them" | tee -a "$log"
fi
end_door
