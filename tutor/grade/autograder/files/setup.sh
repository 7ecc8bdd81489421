#!/usr/bin/env bash
# Installs ros-tutor. Gradescope runs this once, as root, when it builds the image in which submissions are judged.
set -eu
here=$(CDPATH='' cd -P -- "$(dirname -- "$0")" && pwd -P)
# Its images have a python3, but not all of them one that can make a virtual environment.
if ! command -v uv >/dev/null && ! python3 -c 'import ensurepip, venv' 2>/dev/null; then
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -q
    apt-get install -q -y --no-install-recommends python3 python3-venv ca-certificates
fi
# Compiled now, as root, or each start of a node would do it again.
export UV_COMPILE_BYTECODE="${UV_COMPILE_BYTECODE-1}"
exec python3 -I "$here/install.py" /autograder/ros-tutor
