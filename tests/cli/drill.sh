#!/usr/bin/env bash
# Shards on real schedulers: a Slurm of one machine (two nodes, on loopback, in a folder of its own) and GNU parallel run what
# `limner tiles --job` and `limner draw --job` print; one worker is killed half-way; what comes out is what one process draws.
# Usage: drill.sh LIMNER SOURCE slurm|parallel [long]. Left out with a word where the programs are missing.
set -u
limner=$(realpath "$1") source=$2 way=$3 length=${4:-short}
folder=$(mktemp -d)
own=() # processes that were started here
missing=()
need() {
    for program; do command -v "$program" > /dev/null || missing+=("$program"); done
}
PATH=$PATH:/usr/sbin
need python3
if [ "$way" = slurm ]; then need slurmctld slurmd sbatch squeue munged; else need parallel; fi
if [ ${#missing[@]} -gt 0 ]; then
    echo "skipped: ${missing[*]} not found"
    exit 77
fi

finish() {
    local pid
    for pid in "${own[@]}"; do kill "$pid" 2> /dev/null; done
    for pid in "${own[@]}"; do
        for _ in $(seq 50); do kill -0 "$pid" 2> /dev/null || break; sleep 0.1; done
    done
    rm -rf "$folder"
}
trap finish EXIT
fail() {
    echo "drill: $1"
    tail -n 20 "$folder"/*.log "$folder"/slurm/log/* 2> /dev/null
    exit 1
}
cd "$folder" || exit 1
cp "$source/examples/box.glb" model.glb
cp "$source/examples/box-animated.glb" moving.glb
if [ "$length" = long ]; then # 8 blocks: zoom 4 has four windows, the others one each
    zoom=0:4 last=15 shards=8 first=4/8/0
else
    zoom=0:3 last=5 shards=4 first=2/0/0
fi
tiles=(tiles model.glb --look plain --zoom $zoom)
frames=(draw moving.glb --look edges --size 96x96 --frames 0:$last:24)
"$limner" "${tiles[@]}" -o whole --quiet || fail "the tiles cannot be drawn"
"$limner" "${frames[@]}" -o whole-{frame}.png --quiet || fail "the frames cannot be drawn"

# limner, but the second shard's first worker dies by SIGKILL, as one does that has no memory left, when it has written the
# first of its tiles or frames.
cat > wrapper << END
#!/bin/bash
"$limner" "\$@" &
worker=\$!
if [[ "\$*" == *"--shard 2/"* ]] && mkdir killed-\$1 2> /dev/null; then
    [ \$1 = tiles ] && first=sharded/$first.png || first=sharded-0001.png
    while [ ! -e \$first ]; do sleep 0.01; done
    kill -9 \$worker
    echo killed >> kills
fi
wait \$worker
exit \$?
END
chmod +x wrapper

run_slurm() { # SCRIPT
    local job
    job=$(sbatch --parsable "$1") || fail "sbatch refuses the script"
    for _ in $(seq 900); do
        [ -z "$(squeue -h -j "$job" 2> /dev/null)" ] && return
        sleep 0.2
    done
    squeue
    fail "the job does not end"
}

start_slurm() {
    local d=$folder/slurm host port
    host=$(hostname -s) port=$((20000 + $$ % 20000))
    mkdir -p "$d"/{state,spool,log,munge}
    head -c 1024 /dev/urandom > "$d/munge/key"
    chmod 400 "$d/munge/key"
    chmod 711 "$folder" "$d" "$d/munge"
    munged --foreground --force --key-file="$d/munge/key" --socket="$d/munge/sock" --pid-file="$d/munge/pid" \
        --log-file="$d/log/munged" --seed-file="$d/munge/seed" > /dev/null 2>&1 &
    own+=($!)
    echo CgroupPlugin=cgroup/v1 > "$d/cgroup.conf"
    cat > "$d/slurm.conf" << END
ClusterName=limner
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
AuthInfo=socket=$d/munge/sock,cred_expire=5
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
StateSaveLocation=$d/state
SlurmdSpoolDir=$d/spool/%n
SlurmctldPidFile=$d/ctld.pid
SlurmdPidFile=$d/slurmd-%n.pid
SlurmctldLogFile=$d/log/ctld
SlurmdLogFile=$d/log/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
ReturnToService=2
RequeueExit=75
SlurmdParameters=config_overrides
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1 RealMemory=4000
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1 RealMemory=4000
PartitionName=all Nodes=n[1-2] Default=YES State=UP
END
    export SLURM_CONF=$d/slurm.conf
    for _ in $(seq 50); do [ -S "$d/munge/sock" ] && break; sleep 0.1; done
    slurmctld -D -c -f "$SLURM_CONF" > "$d/log/ctld.out" 2>&1 &
    own=($! "${own[@]}")
    for node in n1 n2; do
        slurmd -D -N $node -f "$SLURM_CONF" > "$d/log/$node.out" 2>&1 &
        own=($! "${own[@]}")
    done
    for _ in $(seq 150); do
        [ "$(sinfo -h -o %T 2> /dev/null)" = idle ] && return
        sleep 0.1
    done
    # Containers without addresses or cgroups have none; what can be tested is tested by the other way.
    echo "skipped: no Slurm can be started here"
    tail -n 3 "$d"/log/*
    exit 77
}

# The script with the worker that is killed in the place of the command.
script_of() { # FILE ARGUMENT…
    local file=$1
    shift
    "$limner" "$@" --job "$way" --tasks $shards > printed || fail "no script is printed"
    grep -qF "$limner" printed || fail "the script does not run this limner"
    sed "s|$limner|$folder/wrapper|g" printed > "$file"
}

script_of tiles.job "${tiles[@]}" -o sharded
script_of frames.job "${frames[@]}" -o sharded-{frame}.png
if [ "$way" = slurm ]; then
    start_slurm
    run_slurm tiles.job
    run_slurm frames.job
else
    # The first run loses one task; what the second one does is that alone.
    bash tiles.job > tiles.log 2>&1 && fail "the killed worker went unnoticed"
    bash tiles.job > tiles.log 2>&1 || fail "the second run fails"
    bash frames.job > frames.log 2>&1 && fail "the killed worker went unnoticed"
    bash frames.job > frames.log 2>&1 || fail "the second run fails"
fi
[ "$(wc -l < kills)" = 2 ] || fail "not each job lost a worker"
if [ "$length" = long ]; then # windows
    "$limner" draw model.glb --look plain --size 4096x4096 --dpi 96 --samples 1 -o picture.png --quiet || fail "no picture"
    python3 "$source/tests/cli/tiles.py" sharded 4 256 picture.png || fail "the tiles are not the one big picture"
fi
python3 "$source/tests/cli/tiles.py" same whole sharded || fail "the shards' tiles are not those of one process"
for picture in whole-*.png; do
    cmp -s "$picture" "sharded${picture#whole}" || fail "${picture#whole-} differs"
done
echo "drill: $way: $(find whole -name '*.png' | wc -l) tiles and $(ls whole-*.png | wc -l) frames in $shards shards, a worker of each killed"
