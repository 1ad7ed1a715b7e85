# support.tcl: what every script that is run in a VMD begins with: tests by name, and a file of their results.
#
# The script is run by tests/vmd/run_in_vmd, which names in the environment: RESULT (the file), ESPDIFF (the command
# line), ESPDIFF_DATA (real inputs), SCRATCH (an empty folder).

# Structures without charges are compared by their shapes; prepare.tcl has PDB2PQR.
set env(ESPDIFF_PDB2PQR) /no/such/program
set result_file [open $env(RESULT) w]
set data $env(ESPDIFF_DATA)
set scratch $env(SCRATCH)

proc note {text} {
    global result_file
    puts $result_file $text
    flush $result_file
}

# Runs a test; whatever it throws is its failure.
proc test {name body} {
    if {[catch {uplevel #0 $body} message]} {
        note "FAILED $name: $message"
        note "    [join [lrange [split $::errorInfo \n] 0 6] "\n    "]"
    } else {
        note "ok $name"
    }
}

proc check {what condition} {
    if {![uplevel 1 [list expr $condition]]} {
        set values {}
        foreach name [lsort -unique [regexp -all -inline {\$[a-z_]+} $condition]] {
            upvar 1 [string range $name 1 end] value
            if {[info exists value]} { lappend values "$name = [string range $value 0 200]" }
        }
        error "$what: not true: $condition ([join $values {, }])"
    }
}

proc check_equal {what found expected} {
    if {$found ne $expected} {
        error "$what: '[string range $found 0 400]' instead of '[string range $expected 0 400]'"
    }
}

proc check_close {what found expected tolerance} {
    if {abs($found - $expected) > $tolerance * abs($expected)} { error "$what: $found instead of $expected" }
}

# The script must fail with this errorcode and a message that holds each of the words.
proc check_refused {script code args} {
    if {![catch {uplevel 1 $script} message options]} { error "'$script' was not refused" }
    if {[dict get $options -errorcode] ne $code} {
        error "'$script': errorcode '[dict get $options -errorcode]' instead of '$code'; $message"
    }
    foreach words $args {
        if {[string first $words $message] < 0} { error "'$script': '$words' is not in the message: $message" }
    }
}

# A file of the real inputs; a test that wants one that is absent is skipped with its name.
proc input {name} {
    global data
    set path [file join $data $name]
    if {![file exists $path]} { error "the real input $name is absent" }
    return $path
}

# The fenced block after a marker line of a document.
proc block {document mark} {
    global env
    set channel [open [file join $env(ESPDIFF_TESTS) .. .. docs $document]]
    fconfigure $channel -encoding utf-8
    set text [read $channel]
    close $channel
    set begin [string first "<!-- $mark -->" $text]
    if {$begin < 0} { error "docs/$document has no '$mark'" }
    set begin [expr {[string first \n $text [string first ``` $text $begin]] + 1}]
    return [string range $text $begin [expr {[string first \n``` $text $begin] - 1}]]
}

# Ends the script; without this line the run counts as failed.
proc finish {} {
    global result_file
    note done
    close $result_file
    catch quit
}
