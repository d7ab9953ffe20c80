#!/bin/sh
# generate.sh FASTDDSGEN FILE.idl OUTPUT_DIR
# Generates the C++ types of one IDL file. fastddsgen reports success after many of its own errors, so what counts
# is that every expected file came into being in an empty folder; only then do they replace the previous ones.
set -eu
generator=$1
idl=$2
output=$3
name=$(basename "$idl" .idl)

mkdir -p "$output"
scratch=$(mktemp -d "$output/.generate-$name-XXXXXX")
trap 'rm -rf "$scratch"' EXIT

if ! (cd "$(dirname "$idl")" &&
  "$generator" -cs -replace -t "$scratch" -d "$scratch" "$name.idl") >"$scratch/log" 2>&1; then
  cat "$scratch/log" >&2
  echo "generate.sh: $idl: $generator failed" >&2
  exit 1
fi
# Generators from 4.0 on (Fast DDS 3) write the type's functions into a file of their own and its sizes as constants:
# brought into the two files that the older ones write.
if [ -s "$scratch/$name.hpp" ]; then
  for file in "$name.hpp" "${name}CdrAux.hpp" "${name}CdrAux.ipp"; do
    [ -s "$scratch/$file" ] || continue
    cp "$scratch/$file" "$output/"
  done
  {
    echo '#pragma once'
    echo "#include \"$name.hpp\""
    echo "#include \"${name}CdrAux.hpp\""
    echo 'namespace fathom::v1 {'
    sed -n 's/^constexpr uint32_t fathom_v1_\(.*\)_max_\(key_\)\{0,1\}cdr_typesize .*/\
constexpr uint32_t max_\2cdr_size(const \1*) { return ::fathom_v1_\1_max_\2cdr_typesize; }/p' \
      "$scratch/${name}CdrAux.hpp"
    echo '}'
  } >"$scratch/$name.h"
  echo "#include \"${name}CdrAux.ipp\"" >"$scratch/$name.cxx"
  types=$scratch/$name.hpp
else
  types=$scratch/$name.h
fi
for file in "$name.h" "$name.cxx"; do
  if [ ! -s "$scratch/$file" ]; then
    cat "$scratch/log" >&2
    echo "generate.sh: $idl: $generator ended without an error but did not write $file" >&2
    exit 1
  fi
done
# Every structure of the file must have arrived: the generator drops what it does not understand.
for type in $(sed -n 's/^ *struct \([A-Za-z0-9_]*\).*/\1/p' "$idl"); do
  if ! grep -q "class $type\$" "$types"; then
    cat "$scratch/log" >&2
    echo "generate.sh: $idl: $(basename "$types") has no class $type" >&2
    exit 1
  fi
done
mv -f "$scratch/$name.h" "$scratch/$name.cxx" "$output/"
