# fish completion for roio-sim

function __roio_sim_buses
    set -l buses $ROIO_RUNTIME_DIR
    test -n "$buses"; or set buses /tmp/roio-(id -u)
    for socket in $buses/*.sock
        echo local:(string replace -r '\.sock$' '' (string replace -r '.*/' '' $socket))
    end
end

# "arm:uno=" and then files.
function __roio_sim_boards
    set -l current (commandline -ct)
    set -l name (string match -r '^[^=]*:' -- $current)
    if string match -q '*=*' -- $current
        set -l board (string match -r '^[^=]*=' -- $current)
        for file in (string replace -r '^[^=]*=' '' -- $current)*
            if test -d $file
                echo $board$file/
            else if string match -qr '\.(elf|ino)$' -- $file
                echo $board$file
            end
        end
    else
        for board in uno nano leonardo micro mega
            echo "$name$board="
        end
    end
end

complete -c roio-sim -f
complete -c roio-sim -a '(__roio_sim_boards)'
complete -c roio-sim -s h -l help -d 'Print help and end'
complete -c roio-sim -l version -d 'Print the version and end'
complete -c roio-sim -l bus -x -a '(__roio_sim_buses)' -d 'Join the simulated bus to this one'
complete -c roio-sim -l rate -x -a '125000 250000 500000 1000000' -d 'Of the simulated bus, bit/s'
complete -c roio-sim -l crystal -x -d 'Of the MCP2515: [NAME:]HZ'
complete -c roio-sim -l cs -x -d 'Where chip select is: [NAME:]PIN'
complete -c roio-sim -l int -x -a none -d 'Where INT is: [NAME:]PIN or none'
complete -c roio-sim -l serial-pty -x -d 'Its serial port becomes a terminal: NAME[:PATH]'
complete -c roio-sim -l do -x -d 'Do this first'
complete -c roio-sim -l speed -x -a max -d 'Times real time'
complete -c roio-sim -l for -x -d 'End after so much simulated time, s'
complete -c roio-sim -l json -d 'JSON lines'
complete -c roio-sim -s v -l verbose -d 'Say when it runs'
