# session_script.tcl: the actions in the window as a Tcl script.

namespace eval ::espdiff::gui {
    # By handle and action (compare, draw, map.QUANTITY.MOL, export): the words after `espdiff` without the handle.
    # Repeating an action replaces it, as in VMD.
    variable done [dict create]
    # By handle, and for `trajectory` and `matrix`: how their molecules were loaded, as comments.
    variable loaded [dict create]
    variable prepared [dict create]  ;# by PQR file: the words after `espdiff` that made it

    proc remember_compare {handle source target settings} {
        variable done
        dict set done $handle [dict create compare [concat compare [list $source $target] $settings]]
        remember_molecules $handle [list $source $target]
    }

    proc remember_molecules {what endpoints} {
        variable loaded
        set lines {}
        foreach endpoint $endpoints {
            if {[dict exists $endpoint mol]} { lappend lines [how_loaded [dict get $endpoint mol]] }
        }
        dict set loaded $what [lsort -unique $lines]
    }

    proc remember {handle what words} {
        variable done
        dict set done $handle $what $words
    }

    # Removes an undone action; without `what` all actions of a handle.
    proc forget {handle {what ""}} {
        variable done
        variable loaded
        if {$what eq ""} {
            dict unset done $handle
            dict unset loaded $handle
        } elseif {[dict exists $done $handle $what]} {
            dict unset done $handle $what
        }
    }

    # Comments that say how VMD loaded a molecule.
    proc how_loaded {mol} {
        variable prepared
        set lines {}
        foreach path [lindex [molinfo $mol get filename] 0] {
            if {[dict exists $prepared $path]} {
                return "# Molecule $mol was made and loaded by\n#   espdiff [comment_word [dict get $prepared $path]]\n#  \
                     mol new [comment_word $path] waitfor all"
            }
            lappend lines "#   mol [expr {[llength $lines] == 0 ? "new" : "addfile"}] [comment_word $path] waitfor all"
        }
        return "# Molecule $mol was loaded by\n[join $lines \n]"
    }

    # A word within a comment, which a newline in a file's name would end.
    proc comment_word {word} { return [string map {\n \\n \r \\r} [list $word]] }

    # A script that repeats the actions in the window: the shown comparison with its drawing, the trajectory, the
    # matrix.
    proc session_text {} {
        variable shown
        variable loaded
        set molecules {}
        foreach what [list $shown trajectory matrix] {
            if {[dict exists $loaded $what]} { lappend molecules {*}[dict get $loaded $what] }
        }
        set lines [concat {"package require espdiff"} [lsort -unique $molecules] [pair_lines $shown] \
            [trajectory_lines] [matrix_lines]]
        return [join $lines \n]\n
    }

    proc pair_lines {handle} {
        variable done
        if {$handle eq ""} { return {} }
        set steps [expr {[dict exists $done $handle] ? [dict get $done $handle] : {}}]
        if {![dict exists $steps compare]} {
            # Made by a script: its own call repeats it.
            dict set steps compare [lrange [espdiff result $handle command_line] 1 end]
        }
        set settings [lassign [dict get $steps compare] compare source target]
        # Callbacks of another program are not available.
        if {[llength $settings] % 2 == 0} { set settings [dict remove $settings -command -progress] }
        lappend lines "set comparison \[espdiff compare [list $source] \\"
        lappend lines "    [list $target][option_lines $settings]\]"
        lappend lines {puts [espdiff table $comparison]}
        dict for {what words} [dict remove $steps compare] {
            lappend lines "espdiff [lindex $words 0] \$comparison [lrange $words 1 end]"
        }
        return $lines
    }

    # The run whose rows are shown, from its first frame.
    proc trajectory_lines {} {
        variable trajectory_run
        if {$trajectory_run eq ""} { return {} }
        set options [concat [dict get $trajectory_run options] [dict get $trajectory_run output] {-overwrite 1} \
            [dict get $trajectory_run settings]]
        set lines [list "puts \[espdiff trajectory[option_lines $options]\]"]
        if {[dict exists $trajectory_run plot]} {
            lappend lines "espdiff plot [list [dict get $trajectory_run output -csv]] [dict get $trajectory_run plot]"
        }
        return $lines
    }

    proc matrix_lines {} {
        variable matrix_run
        if {$matrix_run eq ""} { return {} }
        dict with matrix_run {
            return [list "set variants \[list[word_lines $variants]\]" \
                "puts \[espdiff table \[espdiff matrix \$variants[option_lines \
                    [concat [list -output $output -overwrite 1] $settings]]\]\]"]
        }
    }

    proc word_lines {words} {
        set text ""
        foreach word $words { append text " \\\n    [list $word]" }
        return $text
    }

    # Options, each on a continuation line.
    proc option_lines {options} {
        set text ""
        foreach {option value} $options { append text " \\\n    [list $option $value]" }
        return $text
    }

    proc show_script {} {
        variable shown
        variable trajectory_run
        variable matrix_run
        if {$shown eq "" && $trajectory_run eq "" && $matrix_run eq ""} {
            error "nothing has been done yet that a script could repeat; press Compare first"
        }
        text_window script "espdiff: script of this session" [session_text]
    }
}
