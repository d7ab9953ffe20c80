# Sourced by the scripts of this folder: a vehicle on three machines, as network namespaces.
#   hull     simulator, bridges, monitor, the fusion that stands by
#   second   the fusion that leads
#   guide    guidance
# Before: `keep`, the folder to keep logs in, or empty; $0 is named in messages. After: everything runs, `log` is what
# guidance sees, one line of text each (tests/soak/nav_watch.cpp).
bin=$PWD/build/bin watch=$PWD/build/tests/soak_nav_watch
[ "$(id -u)" = 0 ] || { echo "$0: network namespaces need root" >&2; exit 2; }
for tool in ip prlimit; do
  command -v "$tool" >/dev/null || { echo "$0: $tool is not there (packages iproute2, util-linux)" >&2; exit 2; }
done
[ -x "$watch" ] || { echo "$0: $watch is not there; build first (deploy/build all)" >&2; exit 2; }

run=${keep:-$(mktemp -d)}
mkdir -p "$run"
tag=fa$$
machines=(hull second guide hub)
declare -A address=([hull]=10.93.0.1 [second]=10.93.0.2 [guide]=10.93.0.3)
pids=()

clean_up() {
  exec 2>/dev/null  # the shell's own account of who was killed
  for pid in "${pids[@]}"; do kill -9 "$pid" || true; done
  for machine in "${machines[@]}"; do ip netns delete "$tag$machine" || true; done
  umount -l "$run/state" || true
  [ -n "$keep" ] || rm -rf "$run"
}
trap clean_up EXIT

on() { local machine=$1; shift; ip netns exec "$tag$machine" "$@"; }

ip netns add "${tag}hub"
on hub ip link add bridge type bridge
on hub ip link set bridge up
for machine in hull second guide; do
  ip netns add "$tag$machine"
  ip link add cable netns "$tag$machine" type veth peer name "to_$machine" netns "${tag}hub"
  on hub ip link set "to_$machine" master bridge up
  on "$machine" ip address add "${address[$machine]}/24" dev cable
  on "$machine" ip link set lo up
  on "$machine" ip link set cable up
done

peers=()
for machine in hull second guide; do peers+=(--peer "${address[$machine]}"); done
# What the services keep: on a disk of its own, so that it can be full.
state=$run/state
mkdir -p "$state"
mount -t tmpfs -o size=64M fathom "$state"
"$bin/fathom-demo" --commands "$state" --standby --no-console --interface "${address[hull]}" "${peers[@]}"

# set_clock HOW: UTC of hull and second, as libfaketime words it: "+3600" is an hour ahead. Needs faked_clock=1 before.
set_clock() { echo "$1" >"$run/utc.new"; mv "$run/utc.new" "$run/utc"; }
set_clock +0

declare -A pid_of machine_of
start() {  # start MACHINE SERVICE: as commands.txt says, bound to that machine's address, with a clock of its own
  local command clock=()
  command=$(sed -nE "s/^$2\t//p" "$state/commands.txt" | sed -E "s|(clock.anchor_file=[^ ']*)|\1.$1|")
  [ -n "$command" ] || { echo "$0: no service $2 in $state/commands.txt" >&2; exit 4; }
  command+=" --set 'bus.interfaces=[\"${address[$1]}\"]'"
  if [ "${realtime:-}" ] && [[ $2 =~ fusion|imu_bridge ]]; then command+=" --set realtime.policy=fifo"; fi
  if [ "${faked_clock:-}" ] && [ "$1" != guide ]; then
    clock=("LD_PRELOAD=$(ls /usr/lib/*/faketime/libfaketimeMT.so.1)" "FAKETIME_TIMESTAMP_FILE=$run/utc"
      FAKETIME_CACHE_DURATION=1 FAKETIME_DONT_FAKE_MONOTONIC=1)
  fi
  ip netns exec "$tag$1" env "${clock[@]}" bash -c "exec $command" >>"$run/$2.log" 2>&1 &
  pids+=($!)
  pid_of[$2]=$!
  machine_of[$2]=$1
}
watch_from() {  # watch_from FILE [COMMAND...]: guidance, started by that command
  ip netns exec "${tag}guide" "${@:2}" "$watch" --interface "${address[guide]}" "${peers[@]}" --gap 0.06 >"$1" 2>&1 &
  pids+=($!)
  watcher=$!
}

while IFS=$'\t' read -r service _; do
  case "$service" in
    simulator) ;;
    fusion) start second fusion ;;
    guidance_example) start guide guidance_example ;;
    *) start hull "$service" ;;
  esac
done <"$state/commands.txt"
log=$run/guidance.txt
watch_from "$log"
if [ "${realtime:-}" ]; then chrt --all-tasks --fifo --pid 20 "$watcher"; fi
sleep 3
start hull simulator
# It stands for instruments, which wait for no processor.
if [ "${realtime:-}" ]; then sleep 1; chrt --all-tasks --fifo --pid 40 "${pid_of[simulator]}"; fi

now() { cut -d' ' -f1 /proc/uptime; }
# Lines of guidance's log from an instant on.
since() { awk -v from="$1" '$1 >= from' "$log"; }
# The last account, of these two seconds.
newest() { since "$(awk '{print $1 - 2}' /proc/uptime)" | grep " state " | tail -n 1; }
calm() {  # the last account says: full rate, every service well, from the fusion that leads
  kill -0 "$watcher" || { echo "$0: guidance's watch has ended" >&2; exit 4; }
  newest | grep -qE "state fusion .* unwell none$" && [ "$(newest | sed -nE 's/.* rate ([0-9]+) .*/\1/p')" -ge 90 ]
}
wait_calm() {  # wait_calm SECONDS; prints how long it took
  local began=$SECONDS
  sleep 1.5  # an account from before counts for nothing
  while ! calm; do
    [ $((SECONDS - began)) -lt "$1" ] || return 1
    sleep 0.5
  done
  echo $((SECONDS - began))
}

