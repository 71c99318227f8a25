# fish completion for roio-cli

# CAN interfaces of this machine, and local buses that are running.
function __roio_cli_buses
    for folder in /sys/class/net/*
        # 280: ARPHRD_CAN
        if test -r $folder/type; and test (cat $folder/type) = 280
            basename $folder
        end
    end
    set -l buses $ROIO_RUNTIME_DIR
    test -n "$buses"; or set buses /tmp/roio-(id -u)
    for socket in $buses/*.sock
        echo local:(string replace -r '\.sock$' '' (string replace -r '.*/' '' $socket))
    end
end

# Whether the argument being written is the first after the command: the bus.
function __roio_cli_needs_bus
    set -l words (commandline -opc)
    set -l count 0
    set -l skip 0
    for word in $words[3..-1]
        if test $skip = 1
            set skip 0
        else
            switch $word
                case --from --class --count --interval --timeout -n -T -t
                    set skip 1
                case '-?*'
                case '*'
                    set count (math $count + 1)
            end
        end
    end
    test $count = 0
end

complete -c roio-cli -f
complete -c roio-cli -n __fish_use_subcommand -a send -d 'Send a message, or lines of them'
complete -c roio-cli -n __fish_use_subcommand -a dump -d 'Show what is on a bus'
complete -c roio-cli -n __fish_use_subcommand -l version -d 'Print the version and end'
complete -c roio-cli -s h -l help -d 'Print help and end'
complete -c roio-cli -n '__fish_seen_subcommand_from send dump; and __roio_cli_needs_bus' -a '(__roio_cli_buses)'

complete -c roio-cli -n '__fish_seen_subcommand_from send' -l from -x -d 'Source address'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l urgent -d 'Ahead of normal messages'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l class -x -a 'message system stream' -d 'Class of the message'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l count -x -d 'Send so often; 0 until interrupted'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l interval -x -d 'Time between messages, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l timeout -x -d 'Longest wait for the bus, ms'
complete -c roio-cli -n '__fish_seen_subcommand_from send' -l dec -d 'DATA are decimal numbers'

complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s n -x -d 'End after so many frames'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s T -x -d 'End after so many ms without a frame'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s t -x -a 'a\tabsolute d\tdelta z\tzero' -d 'Time of each line'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l log -d 'As candump -L'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l json -d 'JSON lines'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l no-foreign -d 'Hide what is no Roio message'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -l errors -d 'Show error reports'
complete -c roio-cli -n '__fish_seen_subcommand_from dump' -s v -l verbose -d 'Say when listening, and counts'
complete -c roio-cli -n '__fish_seen_subcommand_from dump; and not __roio_cli_needs_bus' -a 'to= from= urgent normal class=message class=system class=stream or'
