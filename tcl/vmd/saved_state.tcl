# saved_state.tcl: VMD's saved states hold the command that makes a drawing again, instead of its triangles.

# VMD would save a drawing as a line for each triangle, with colours by the numbers of a scale that it does not have
# then. So drawings and their materials are taken away while it saves, and made again afterwards.
namespace eval ::espdiff {
    variable taken_away {}  ;# during save_state: {handle options} of the drawings, {name settings} of the materials

    # VMD's procedure is loaded at its first use.
    proc watch_save_state {} {
        variable drawings
        if {[info procs ::save_state] eq "" && [catch { auto_load save_state } found] || [info procs ::save_state] eq ""} return
        foreach {name when action} {
            ::save_state enter ::espdiff::before_save_state ::save_state leave ::espdiff::after_save_state
            ::save_labels enter ::espdiff::during_save_state
        } {
            if {[info procs $name] eq ""} continue
            trace remove execution $name $when $action
            if {[dict size $drawings] > 0} { trace add execution $name $when $action }
        }
    }

    proc before_save_state {args} {
        variable drawings
        variable drawn_options
        variable taken_away
        set kept {}
        dict for {handle molecules} $drawings { lappend kept [list $handle [dict get $drawn_options $handle]] }
        set taken_away [dict create drawings $kept materials {}]
        foreach drawing $kept { forget_drawing [lindex $drawing 0] }
        foreach name [lsearch -all -inline -regexp [material list] {^Espdiff(\d+|Flat)$}] {
            dict lappend taken_away materials [list $name [material settings $name]]
            material delete $name
        }
        # forget_drawing has removed the traces with the last drawing.
        trace add execution ::save_labels enter ::espdiff::during_save_state
        trace add execution ::save_state leave ::espdiff::after_save_state
    }

    # The last part of the file is written by `save_labels CHANNEL`.
    proc during_save_state {command args} {
        variable taken_away
        if {$taken_away eq ""} return
        foreach drawing [dict get $taken_away drawings] {
            catch { puts [lindex $command 1] [state_lines {*}$drawing] }
        }
    }

    proc after_save_state {args} {
        variable taken_away
        if {$taken_away eq ""} return
        set state $taken_away
        set taken_away {}
        trace remove execution ::save_labels enter ::espdiff::during_save_state
        trace remove execution ::save_state leave ::espdiff::after_save_state
        foreach material [dict get $state materials] { restore_material {*}$material }
        foreach drawing [dict get $state drawings] {
            lassign $drawing handle options
            if {[catch { draw $options $handle } message]} { say "$handle is not drawn again: $message" }
        }
    }

    proc restore_material {name settings} {
        if {$name ni [material list]} { material add $name copy Opaque }
        foreach property {ambient specular diffuse shininess mirror opacity outline outlinewidth transmode} value $settings {
            catch { material change $property $name $value }
        }
    }

    # The commands that make a drawing again, after the state's molecules were loaded: they are then the last ones.
    proc state_lines {handle options} {
        variable jobs
        set call [dict get $jobs $handle call]
        set command [lindex $call 1]
        set drawn {}
        dict for {option value} [dict remove $options settings] { append drawn " [list -$option $value]" }
        if {$command eq "ensemble"} { return [guarded_lines {} [ensemble_again $handle $call] $drawn] }
        set n [expr {$command eq "compare" ? 2 : 1}]
        set molecules [molinfo list]
        set names [dict create]
        set lines {}
        for {set i 0} {$i < [llength $molecules]} {incr i} {
            dict set names [lindex $molecules $i] \$espdiff_mol[lindex $molecules $i]
        }
        set words "espdiff $command"
        set sides [lrange $call 2 [expr {1 + $n}]]
        foreach endpoint $sides side [lrange {source target} 0 [expr {$n - 1}]] {
            # `now` is another frame when the state is read.
            if {[dict exists $endpoint mol]} { dict set endpoint frame [dict get $jobs $handle ${side}_frame] }
            foreach mol [molecules_named $endpoint] {
                set place [expr {[llength $molecules] - 1 - [lsearch -exact $molecules $mol]}]
                lappend lines "    set espdiff_mol$mol \[lindex \[molinfo list\] end-$place\]"
            }
            append words " [script_word $endpoint $names]"
        }
        set settings [dict remove [lrange $call [expr {2 + $n}] end] -command -progress]
        append words " [join [script_words $settings {}]]"
        return [guarded_lines [lsort -unique $lines] [string trim $words] $drawn]
    }

    # A command that draws again, whose error leaves the rest of the state alone.
    proc guarded_lines {lines words drawn} {
        return [join [concat [list "# A drawing of espdiff" "if \{\[catch \{" "    package require espdiff"] $lines \
            [list "    espdiff draw \[$words\]$drawn" \
            "\} espdiff_message\]\} \{ puts \"espdiff) a drawing was not made again: \$espdiff_message\" \}"]] \n]
    }

    # The statistics of the frames that were mapped: nothing is mapped again.
    proc ensemble_again {handle call} {
        set files [dict get [core::result $handle] files]
        set options [dict remove [lrange $call 3 end] -command -progress -output -resume -overwrite -check-template]
        set kept {}
        foreach name {-alpha -control -equilibration -most-missing -permutations -seed} {
            if {[dict exists $options $name]} { lappend kept $name [dict get $options $name] }
        }
        set h5 [lsearch -inline -glob $files *.h5]
        if {$h5 eq ""} { set h5 [dict get $options -from] }
        return [concat espdiff ensemble [list {}] [list -from [full_name $h5] \
            -output [file rootname [full_name [lsearch -inline -glob $files *.json]]]] $kept]
    }
}
