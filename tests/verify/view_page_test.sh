#!/bin/sh
# view_page_test.sh VIEW_DEMO FOLDER: loads the demonstration page in headless Chromium.
# Exit code 77 means: not run, because a program is missing.
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
if [ -z "$browser" ] || ! command -v node >/dev/null; then
  echo "SKIPPED: needs chromium and node (Debian: apt-get install chromium nodejs)" >&2
  exit 77
fi
exec node "$(dirname "$0")/view_page_test.mjs" "$browser" "$1" "$2"
