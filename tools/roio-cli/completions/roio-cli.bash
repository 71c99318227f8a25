# bash completion for roio-cli

# CAN interfaces of this machine, and local buses that are running.
_roio_cli_buses() {
  local folder type socket
  for folder in /sys/class/net/*; do
    # 280: ARPHRD_CAN
    read -r type 2>/dev/null <"$folder/type" && [ "$type" = 280 ] && echo "${folder##*/}"
  done
  for socket in "${ROIO_RUNTIME_DIR:-/run/user/$UID/roio}"/*.sock \
    "${ROIO_RUNTIME_DIR:-/tmp/roio-$UID}"/*.sock; do
    socket=${socket##*/}
    [ "$socket" = '*.sock' ] || echo "local:${socket%.sock}"
  done | sort -u
}

# Serial ports where a bridge may be; opening them to see would restart what else is there.
_roio_cli_ports() {
  local port
  echo auto
  for port in /dev/ttyACM* /dev/ttyUSB*; do
    [ -e "$port" ] && echo "$port"
  done
}

_roio_cli_all_buses() {
  _roio_cli_buses
  _roio_cli_ports | sed s/^/serial:/
}

# How many words, from the one given to the current one, are arguments, not options or their values.
_roio_cli_arguments_before() {
  local index count=0
  for ((index = $1; index < COMP_CWORD; ++index)); do
    case ${COMP_WORDS[index]} in
      --from | --class | --count | --interval | --timeout | -n | -T | -t | -b) ((++index)) ;;
      -o | --output | --speed | --gap | --robot) ((++index)) ;;
      --bitrate | --mode | --address | --seconds) ((++index)) ;;
      --load | --rate | --size | --to | --id | --seed | --time) ((++index)) ;;
      -?*) ;;
      *) ((++count)) ;;
    esac
  done
  echo "$count"
}

_roio_cli_words() {
  local command=${COMP_WORDS[1]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  if [ "$COMP_CWORD" -eq 1 ]; then
    echo send ask dump top record play gen buses hub attach bridge kind robot help --help --version
    return
  fi
  case $previous in
    --class) echo message system stream; return ;;
    --mode) echo normal listen loopback; return ;;
    --address) echo none; return ;;
    -t) echo a A d z; return ;;
    -b) _roio_cli_all_buses; return ;;
    -o | --robot) compgen -f -- "$current"; return ;;
    --speed) echo max; return ;;
    --size) echo random; return ;;
    --from | --to) [ "$command" = gen ] && echo random; return ;;
    --count | --interval | --timeout | --gap | -n | -T | --bitrate | --seconds) return ;;
    --load | --rate | --id | --seed | --time) return ;;
  esac
  case $command:$current in
    send:-*) echo --robot --from --urgent --class --count --interval --timeout --wait --dec --help; return ;;
    ask:-*) echo --robot --from --urgent --class --timeout --json --dec --help; return ;;
    top:-*) echo --robot --bitrate --interval -n --json --help; return ;;
    gen:-*) echo --robot --check --load --rate --bitrate --size --from --to --urgent --id --seed --count --time -T --timeout --verbose --help; return ;;
    attach:-*) echo --verbose --help; return ;;
    dump:-*) echo --robot -x -n -T -t -b -c --log --json --csv --pcap --no-foreign --errors --verbose --help; return ;;
    record:-*) echo --robot -o --force --csv --pcap -n -T --no-foreign --errors -b --help; return ;;
    play:-*) echo --speed --gap --from --to --loop --timeout --wait --help; return ;;
    buses:-*) echo --json --help; return ;;
    hub:-*) echo --bitrate --help; return ;;
    send:* | ask:* | dump:* | record:* | top:* | gen:*) ;;
    attach:*) [ "$(_roio_cli_arguments_before 2)" -lt 2 ] && _roio_cli_all_buses; return ;;
    play:*) _roio_cli_play_words; return ;;
    hub:*) _roio_cli_buses; return ;;
    bridge:*) _roio_cli_bridge_words; return ;;
    kind:*) _roio_cli_kind_words; return ;;
    robot:*) _roio_cli_robot_words; return ;;
    help:*) [ "$COMP_CWORD" -eq 2 ] && echo send ask dump top record play gen buses hub attach bridge kind robot; return ;;
    *) return ;;
  esac
  if [ "$(_roio_cli_arguments_before 2)" -eq 0 ]; then
    _roio_cli_all_buses
  elif [ "$command" = dump ] || [ "$command" = record ]; then
    echo to= from= urgent normal class=message class=system class=stream or
  fi
}

# The log, and then where it goes.
_roio_cli_play_words() {
  if [ "$(_roio_cli_arguments_before 2)" -eq 0 ]; then
    compgen -f -- "$current"
  else
    _roio_cli_all_buses
  fi
}

_roio_cli_bridge_words() {
  local action=${COMP_WORDS[2]}
  if [ "$COMP_CWORD" -eq 2 ]; then
    echo show set identify attach --help
    return
  fi
  case $action:$current in
    show:-*) echo --json --help; return ;;
    set:-*) echo --bitrate --mode --address --help; return ;;
    identify:-*) echo --seconds --help; return ;;
    attach:-*) echo --verbose --help; return ;;
  esac
  case $action:$(_roio_cli_arguments_before 3) in
    show:0 | set:0 | identify:0 | attach:0) _roio_cli_ports ;;
    attach:1) _roio_cli_buses ;;
  esac
}

# Files whose names end so, and folders on the way to them.
_roio_cli_files() {
  compgen -f -X "!*$1" -- "$current"
  compgen -d -S / -- "$current"
}

_roio_cli_kind_words() {
  local action=${COMP_WORDS[2]}
  if [ "$COMP_CWORD" -eq 2 ]; then
    echo header js md --help
    return
  fi
  case $previous in
    -o | --output) compgen -f -- "$current"; return ;;
  esac
  case $action:$current in
    header:-*) echo --output --check --help; return ;;
    js:-*) echo --output --check --help; return ;;
    md:-*) echo --output --check --help; return ;;
  esac
  [ "$(_roio_cli_arguments_before 3)" -eq 0 ] && _roio_cli_files .kind.json
}

_roio_cli_robot_words() {
  local action=${COMP_WORDS[2]}
  if [ "$COMP_CWORD" -eq 2 ]; then
    echo check dbc --help
    return
  fi
  case $previous in
    -o | --output) compgen -f -- "$current"; return ;;
  esac
  case $action:$current in
    check:-*) echo --help; return ;;
    dbc:-*) echo --output --check --help; return ;;
  esac
  [ "$(_roio_cli_arguments_before 3)" -eq 0 ] && _roio_cli_files .json
}

_roio_cli() {
  local current words COMP_CWORD=$COMP_CWORD COMP_WORDS=("${COMP_WORDS[@]}")
  # "local:robot" and "class=system" are one word each, whatever bash cuts words at.
  _roio_cli_join
  current=${COMP_WORDS[COMP_CWORD]}
  words=$(_roio_cli_words)
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  # bash replaces only what follows the last colon or equals sign.
  local kept=${current%"${current##*[:=]}"} index
  for index in "${!COMPREPLY[@]}"; do
    COMPREPLY[index]=${COMPREPLY[index]#"$kept"}
  done
  [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *= ]] && compopt -o nospace 2>/dev/null
  return 0
}

# Puts the words that bash cut at ':' and '=' together again.
_roio_cli_join() {
  local joined=() index word position=0 glue=
  for index in "${!COMP_WORDS[@]}"; do
    word=${COMP_WORDS[index]}
    if [[ ${#joined[@]} -gt 0 && ($word =~ ^[:=]+$ || -n $glue) ]]; then
      joined[-1]+=$word
    else
      joined+=("$word")
    fi
    glue=
    [[ $word =~ ^[:=]+$ ]] && glue=1
    [ "$index" -eq "$COMP_CWORD" ] && position=$((${#joined[@]} - 1))
  done
  COMP_WORDS=("${joined[@]}")
  COMP_CWORD=$position
}

complete -F _roio_cli roio-cli
