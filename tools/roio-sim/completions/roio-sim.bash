# bash completion for roio-sim

_roio_sim_local_buses() {
  local socket
  for socket in "${ROIO_RUNTIME_DIR:-/tmp/roio-$UID}"/*.sock; do
    socket=${socket##*/}
    [ "$socket" = '*.sock' ] || echo "local:${socket%.sock}"
  done
}

_roio_sim_words() {
  case $previous in
    --bus) _roio_sim_local_buses; return ;;
    --rate) echo 125000 250000 500000 1000000; return ;;
    --speed) echo max; return ;;
    --int) echo none; return ;;
    --for | --crystal | --cs | --serial-pty | --do) return ;;
  esac
  case $current in
    -*) echo --bus --rate --crystal --cs --int --serial-pty --do --speed --for --json --verbose --help --version; return ;;
    *=*) compgen -f -X '!*.elf' -P "${current%%=*}=" -- "${current#*=}"
         compgen -f -X '!*.ino' -P "${current%%=*}=" -- "${current#*=}"
         compgen -d -S / -P "${current%%=*}=" -- "${current#*=}"; return ;;
    *:*) local name=${current%%:*}
         echo "$name:uno= $name:nano= $name:leonardo= $name:micro= $name:mega="; return ;;
  esac
  echo uno= nano= leonardo= micro= mega=
}

_roio_sim() {
  local current previous words COMP_CWORD=$COMP_CWORD COMP_WORDS=("${COMP_WORDS[@]}")
  # "local:robot" and "arm:uno=Arm.elf" are one word each, whatever bash cuts words at.
  _roio_sim_join
  current=${COMP_WORDS[COMP_CWORD]}
  previous=${COMP_WORDS[COMP_CWORD - 1]}
  words=$(_roio_sim_words)
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  # bash replaces only what follows the last colon or equals sign.
  local kept=${current%"${current##*[:=]}"} index
  for index in "${!COMPREPLY[@]}"; do
    COMPREPLY[index]=${COMPREPLY[index]#"$kept"}
  done
  [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *[=/] ]] && compopt -o nospace 2>/dev/null
  return 0
}

# Puts the words that bash cut at ':' and '=' together again.
_roio_sim_join() {
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

complete -F _roio_sim roio-sim
