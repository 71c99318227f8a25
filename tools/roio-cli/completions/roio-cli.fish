# fish completion for roio-cli

# CAN interfaces of this machine, and local buses that are running.
function __roio_cli_buses
    for folder in /sys/class/net/*
        # 280: ARPHRD_CAN
        if test -r $folder/type; and test (cat $folder/type) = 280
            basename $folder
        end
    end
    set -l folders $ROIO_RUNTIME_DIR
    test -n "$folders"; or set folders /run/user/(id -u)/roio /tmp/roio-(id -u)
    for socket in $folders/*.sock
        echo local:(string replace -r '\.sock$' '' (string replace -r '.*/' '' $socket))
    end
end

# Serial ports where a bridge may be; opening them to see would restart what else is there.
function __roio_cli_ports
    echo auto
    for port in /dev/ttyACM* /dev/ttyUSB*
        echo $port
    end
end

# Whether the argument being written is the N-th from 0, from the M-th word of the line on.
function __roio_cli_is_argument
    set -l words (commandline -opc)
    set -l count 0
    set -l skip 0
    for word in $words[$argv[2]..-1]
        if test $skip = 1
            set skip 0
        else
            switch $word
                case --from --class --count --interval --timeout -n -T -t -b -o --output --speed --gap --to --robot --bitrate --mode --address --seconds --load --rate --size --id --seed --time
                    set skip 1
                case '-?*'
                case '*'
                    set count (math $count + 1)
            end
        end
    end
    test $count = $argv[1]
end

# Whether it is the bus, the first after the command.
function __roio_cli_needs_bus
    __roio_cli_is_argument 0 3
end

# Whether `bridge` is the command and its own command is not there yet, or is the one given.
function __roio_cli_bridge
    set -l words (commandline -opc)
    test "$words[2]" = bridge; and test "$words[3]" = "$argv[1]"
end

# The same of `kind` and `robot`.
function __roio_cli_kind
    set -l words (commandline -opc)
    test "$words[2]" = kind; and test "$words[3]" = "$argv[1]"
end
function __roio_cli_robot
    set -l words (commandline -opc)
    test "$words[2]" = robot; and test "$words[3]" = "$argv[1]"
end

# Whether `attach` is the command itself, not bridge's.
function __roio_cli_attach
    set -l words (commandline -opc)
    test "$words[2]" = attach
end

# Whether it is the N-th from 0 after the one given of bridge's commands.
function __roio_cli_bridge_argument
    __roio_cli_bridge $argv[1]; and __roio_cli_is_argument $argv[2] 4
end

complete -c roio-cli -f
complete -c roio-cli -n __fish_use_subcommand -a send -d 'Send a message, or lines of them'
complete -c roio-cli -n __fish_use_subcommand -a ask -d 'Send a message, and print the answer'
complete -c roio-cli -n __fish_use_subcommand -a dump -d 'Show what is on a bus'
complete -c roio-cli -n __fish_use_subcommand -a top -d 'Show who is on a bus, live'
complete -c roio-cli -n __fish_use_subcommand -a record -d 'Keep what is on a bus in a file'
complete -c roio-cli -n __fish_use_subcommand -a play -d 'Send what a log has, when it says'
complete -c roio-cli -n __fish_use_subcommand -a gen -d 'Send numbered messages, or check them'
complete -c roio-cli -n __fish_use_subcommand -a buses -d 'List the buses that can be opened'
complete -c roio-cli -n __fish_use_subcommand -a hub -d 'Carry a local bus until a signal'
complete -c roio-cli -n __fish_use_subcommand -a attach -d 'Make two buses one'
complete -c roio-cli -n __fish_use_subcommand -a bridge -d 'Show, set and use a bridge on a serial port'
complete -c roio-cli -n __fish_use_subcommand -a kind -d 'Make code and pages from messages'
complete -c roio-cli -n __fish_use_subcommand -a robot -d 'Look at a robot file, and make a DBC'
complete -c roio-cli -n __fish_use_subcommand -a help -d 'Print the help of a command'
complete -c roio-cli -n __fish_use_subcommand -l version -d 'Print the version and end'
complete -c roio-cli -s h -l help -d 'Print help and end'
complete -c roio-cli -n '__fish_seen_subcommand_from send ask dump record top gen; and __roio_cli_needs_bus' -a '(__roio_cli_buses) serial:(__roio_cli_ports)'

complete -c roio-cli -n '__fish_seen_subcommand_from send' -l from -x -d 'Source address'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l urgent -d 'Ahead of normal messages'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l class -x -a 'message system stream' -d 'Class of the message'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l count -x -d 'Send so often; 0 until interrupted'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l interval -x -d 'Time between messages, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l timeout -x -d 'Longest wait for the bus, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l wait -d 'Until somebody listens on a local bus'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l dec -d 'DATA are decimal numbers'

complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s n -x -d 'End after so many frames'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s T -x -d 'End after so many ms without a frame'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s t -x -a 'a\tabsolute A\tdated d\tdelta z\tzero' -d 'Time of each line'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l log -d 'As candump -L'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l json -d 'JSON lines'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l csv -d 'Comma-separated values'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l pcap -d 'A capture for Wireshark'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s c -d 'A colour for each source'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s b -x -a '(__roio_cli_buses) serial:(__roio_cli_ports)' -d 'One more bus'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l no-foreign -d 'Hide what is no Roio message'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l errors -d 'Show error reports'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s v -l verbose -d 'Say when listening, and counts'
complete -c roio-cli -n '__fish_seen_subcommand_from dump record; and not __roio_cli_needs_bus' -a 'to= from= urgent normal class=message class=system class=stream or'

complete -c roio-cli -n '__fish_seen_subcommand_from ask' -l from -x -d 'Own address, that answers go to'
complete -c roio-cli -n '__fish_seen_subcommand_from ask' -l urgent -d 'Ahead of normal messages'
complete -c roio-cli -n '__fish_seen_subcommand_from ask' -l class -x -a 'message system stream' -d 'Class of the message'
complete -c roio-cli -n '__fish_seen_subcommand_from ask' -l timeout -x -d 'Longest wait for the answer, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from ask' -l json -d 'The answer as a JSON line'
complete -c roio-cli -n '__fish_seen_subcommand_from ask' -l dec -d 'DATA are decimal numbers'

complete -c roio-cli -n '__fish_seen_subcommand_from top' -l bitrate -x -d 'Of a bus that does not tell, bit/s'
complete -c roio-cli -n '__fish_seen_subcommand_from top' -l interval -x -d 'Between two screens or sets of lines, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from top' -s n -x -d 'End after so many of them'
complete -c roio-cli -n '__fish_seen_subcommand_from top' -l json -d 'JSON lines, also on a terminal'

complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l check -d 'Receive them, and say what became of them'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l load -x -d 'Share of the bus, percent'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l rate -x -d 'Messages a second'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l bitrate -x -d 'Of a bus that does not tell, bit/s'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l size -x -a 'random' -d 'Bytes, 4 to 8'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l from -x -a random -d 'Source'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l to -x -a random -d 'Destination'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l urgent -d 'Ahead of normal messages'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l id -x -d 'Of this generator, 0 to 127'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l seed -x -d 'Of what is random'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l count -x -d 'End after so many messages'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l time -x -d 'End after so long, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -s T -x -d 'Check: end after so long without one, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l timeout -x -d 'Longest wait for the bus, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -s v -l verbose -d 'Check: say when listening'

complete -c roio-cli -n '__roio_cli_attach' -s v -l verbose -d 'Say the counts once a second'
complete -c roio-cli -n '__roio_cli_attach; and not __roio_cli_is_argument 2 3' -a '(__roio_cli_buses) serial:(__roio_cli_ports)'

complete -c roio-cli -n '__fish_seen_subcommand_from record' -s o -r -F -d 'Where to'
complete -c roio-cli -n '__fish_seen_subcommand_from record' -l force -d 'Overwrite the file'
complete -c roio-cli -n '__fish_seen_subcommand_from record' -l csv -d 'Comma-separated values'
complete -c roio-cli -n '__fish_seen_subcommand_from record' -l pcap -d 'A capture for Wireshark'
complete -c roio-cli -n '__fish_seen_subcommand_from record' -s n -x -d 'End after so many frames'
complete -c roio-cli -n '__fish_seen_subcommand_from record' -s T -x -d 'End after so many ms without a frame'
complete -c roio-cli -n '__fish_seen_subcommand_from record' -l no-foreign -d 'Leave out what is no Roio message'
complete -c roio-cli -n '__fish_seen_subcommand_from record' -l errors -d 'Error reports too'
complete -c roio-cli -n '__fish_seen_subcommand_from record' -s b -x -a '(__roio_cli_buses) serial:(__roio_cli_ports)' -d 'One more bus'

complete -c roio-cli -n '__fish_seen_subcommand_from play' -l speed -x -a max -d 'Times as fast as the log'
complete -c roio-cli -n '__fish_seen_subcommand_from play' -l gap -x -d 'Cut longer pauses, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from play' -l from -x -d 'Begin at this time of the log'
complete -c roio-cli -n '__fish_seen_subcommand_from play' -l to -x -d 'End after this time of the log'
complete -c roio-cli -n '__fish_seen_subcommand_from play' -l loop -d 'Again and again'
complete -c roio-cli -n '__fish_seen_subcommand_from play' -l timeout -x -d 'Longest wait for the bus, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from play' -l wait -d 'Until somebody listens on a local bus'
complete -c roio-cli -n '__fish_seen_subcommand_from play; and __roio_cli_needs_bus' -F
complete -c roio-cli -n '__fish_seen_subcommand_from play; and not __roio_cli_needs_bus' -a '(__roio_cli_buses) serial:(__roio_cli_ports)'

complete -c roio-cli -n '__fish_seen_subcommand_from send' -l robot -r -F -d 'Robot file with the names'
complete -c roio-cli -n '__fish_seen_subcommand_from ask' -l robot -r -F -d 'Robot file with the names'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l robot -r -F -d 'Robot file with the names'
complete -c roio-cli -n '__fish_seen_subcommand_from record' -l robot -r -F -d 'Robot file with the names'
complete -c roio-cli -n '__fish_seen_subcommand_from top' -l robot -r -F -d 'Robot file with the names'
complete -c roio-cli -n '__fish_seen_subcommand_from gen' -l robot -r -F -d 'Robot file with the names'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s x -d 'Bytes in place of names'

complete -c roio-cli -n 'set -l words (commandline -opc); test (count $words) = 2; and test $words[2] = help' -a 'send ask dump top record play gen buses hub attach bridge kind robot'

complete -c roio-cli -n '__fish_seen_subcommand_from hub' -l bitrate -x -d 'Pace of the bus, bit/s'
complete -c roio-cli -n '__fish_seen_subcommand_from hub; and __roio_cli_needs_bus' -a '(__roio_cli_buses)'

complete -c roio-cli -n '__fish_seen_subcommand_from buses' -l json -d 'JSON lines'

complete -c roio-cli -n '__roio_cli_bridge ""' -a show -d 'What a bridge is and has counted'
complete -c roio-cli -n '__roio_cli_bridge ""' -a set -d 'Bit rate, mode and address'
complete -c roio-cli -n '__roio_cli_bridge ""' -a identify -d 'Have its LED blink'
complete -c roio-cli -n '__roio_cli_bridge ""' -a attach -d 'Make it and another bus one bus'
for command in show set identify attach
    complete -c roio-cli -n "__roio_cli_bridge_argument $command 0" -a '(__roio_cli_ports)'
end
complete -c roio-cli -n '__roio_cli_bridge_argument attach 1' -a '(__roio_cli_buses)'
complete -c roio-cli -n '__roio_cli_bridge show' -l json -d 'One JSON object'
complete -c roio-cli -n '__roio_cli_bridge set' -l bitrate -x -d 'Of the CAN bus'
complete -c roio-cli -n '__roio_cli_bridge set' -l mode -x -a 'normal listen loopback' -d 'Of the controller'
complete -c roio-cli -n '__roio_cli_bridge set' -l address -x -a none -d 'That it answers to as a node'
complete -c roio-cli -n '__roio_cli_bridge identify' -l seconds -x -d 'How long; 0 ends it'
complete -c roio-cli -n '__roio_cli_bridge attach' -s v -l verbose -d 'Say the counts once a second'

complete -c roio-cli -n '__roio_cli_kind ""' -a header -d 'A C++11 header'
complete -c roio-cli -n '__roio_cli_kind ""' -a js -d 'An ES module'
complete -c roio-cli -n '__roio_cli_kind ""' -a md -d 'A page for people'
complete -c roio-cli -n '__roio_cli_kind header' -s o -l output -r -F -d 'Write to this file'
complete -c roio-cli -n '__roio_cli_kind header' -l check -d 'Write nothing; exit 1 when that file is stale'
complete -c roio-cli -n '__roio_cli_kind header; and __roio_cli_is_argument 0 4' -a '(__fish_complete_suffix .kind.json)'
complete -c roio-cli -n '__roio_cli_kind js' -s o -l output -r -F -d 'Write to this file'
complete -c roio-cli -n '__roio_cli_kind js' -l check -d 'Write nothing; exit 1 when that file is stale'
complete -c roio-cli -n '__roio_cli_kind js; and __roio_cli_is_argument 0 4' -a '(__fish_complete_suffix .kind.json)'
complete -c roio-cli -n '__roio_cli_kind md' -s o -l output -r -F -d 'Write to this file'
complete -c roio-cli -n '__roio_cli_kind md' -l check -d 'Write nothing; exit 1 when that file is stale'
complete -c roio-cli -n '__roio_cli_kind md; and __roio_cli_is_argument 0 4' -a '(__fish_complete_suffix .kind.json)'

complete -c roio-cli -n '__roio_cli_robot ""' -a check -d 'What a robot has'
complete -c roio-cli -n '__roio_cli_robot ""' -a dbc -d 'A DBC file'
complete -c roio-cli -n '__roio_cli_robot dbc' -s o -l output -r -F -d 'Write to this file'
complete -c roio-cli -n '__roio_cli_robot dbc' -l check -d 'Write nothing; exit 1 when that file is stale'
for command in check dbc
    complete -c roio-cli -n "__roio_cli_robot $command; and __roio_cli_is_argument 0 4" -a '(__fish_complete_suffix .json)'
end
