# Sourced by the scripts of this folder that make roots of whole systems.

# archive_of MAKER: where this host has its own packages from when they are of that maker (debian, ubuntu), else nothing.
archive_of() {
  # shellcheck disable=SC2016  # apt fills in what is in parentheses
  apt-get indextargets --format '$(ORIGIN) $(REPO_URI)' 'Created-By: Packages' 2>/dev/null |
    awk -v maker="$1" 'tolower($1) == maker && $2 !~ /security/ {print $2; exit}'
}
