# debian-root.bash: a root of another Debian, made by debootstrap, and commands in it; sourced by scripts that try the project
# there, after common.bash.

# make_debian_root SUITE FOLDER: keeps a root that is there. Sets `settings`, the environment of commands in it.
make_debian_root() {
  local suite="$1" root="$2" mirror certificates name
  if [[ ! -e "$root/usr/bin/apt-get" ]]; then
    command -v debootstrap >/dev/null || apt-get -qq install -y --no-install-recommends debootstrap >/dev/null
    mirror="$(apt-get indextargets --format '$(REPO_URI)' | grep '/debian/$' | sort -u | head -n 1)"
    [[ -n "$mirror" ]] || fail "apt knows no mirror of Debian (apt-get indextargets)"
    say "making a root of Debian $suite in $root"
    debootstrap --variant=minbase "$suite" "$root" "$mirror" >"$root.log" 2>&1 || { tail -n 20 "$root.log" >&2; fail "debootstrap failed"; }
    rm -f "$root.log"
    chmod 755 "$root"  # apt fetches as a user of its own
    mkdir -p "$root/etc/apt/apt.conf.d"
    echo 'Acquire::Languages "none";' >"$root/etc/apt/apt.conf.d/90no-translations"
    mkdir -p "$root/etc/dpkg/dpkg.cfg.d"
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/90no-syncs"  # a machine that loses power makes the root anew
  fi
  # Where names are looked up and which certificates hold are this machine's affair.
  cp -L /etc/resolv.conf "$root/etc/resolv.conf"
  settings=(HOME=/root LANG=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin)
  for name in http_proxy https_proxy no_proxy PIP_INDEX_URL PIP_EXTRA_INDEX_URL; do
    if [[ -n "${!name:-}" ]]; then settings+=("$name=${!name}"); fi
  done
  certificates="${PIP_CERT:-${SSL_CERT_FILE:-}}"
  if [[ -f "$certificates" ]]; then
    cp -L "$certificates" "$root/root/certificates.pem"
    settings+=(PIP_CERT=/root/certificates.pem SSL_CERT_FILE=/root/certificates.pem)
  fi
}

# inside_root ROOT COMMAND: runs it in /root/espdiff of the root, with the file systems that programs expect; they are gone
# when it ends.
inside_root() {
  mkdir -p "$1/root/espdiff"
  unshare --mount --propagation private bash -c '
    for name in proc sys dev; do mount --rbind "/$name" "$0/$name"; done
    mount -t tmpfs tmpfs "$0/dev/shm" 2>/dev/null || true
    exec chroot "$0" env -i "${@:2}" bash -c "cd /root/espdiff && $1"' "$1" "$2" "${settings[@]}"
}
