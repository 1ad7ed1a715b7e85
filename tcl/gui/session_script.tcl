# session_script.tcl: what was done in the window as a Tcl script.

namespace eval ::espdiff::gui {
    # By handle: by what was done (compare, draw, map.QUANTITY.MOL, export), the words after `espdiff` without the
    # handle. Doing something again replaces it, as it does in VMD.
    variable done [dict create]
    variable loaded [dict create]  ;# by handle: how the molecules that it came from were loaded, as comments

    proc remember_compare {handle source target settings} {
        variable done
        variable loaded
        dict set done $handle [dict create compare [concat compare [list $source $target] $settings]]
        set lines {}
        foreach endpoint [list $source $target] {
            if {[dict exists $endpoint mol]} { lappend lines [how_loaded [dict get $endpoint mol]] }
        }
        dict set loaded $handle [lsort -unique $lines]
    }

    proc remember {handle what words} {
        variable done
        dict set done $handle $what $words
    }

    # What was undone; without `what` all that is known of a handle.
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

    # Comments that say how VMD came by a molecule.
    proc how_loaded {mol} {
        set lines {}
        foreach path [lindex [molinfo $mol get filename] 0] {
            lappend lines "#   mol [expr {[llength $lines] == 0 ? "new" : "addfile"}] [list $path] waitfor all"
        }
        return "# Molecule $mol was loaded by\n[join $lines \n]"
    }

    # A script that does with this result's molecules or files what was done in the window.
    proc script_text {handle} {
        variable done
        variable loaded
        set lines {"package require espdiff"}
        if {[dict exists $loaded $handle]} { lappend lines {*}[dict get $loaded $handle] }
        set steps [expr {[dict exists $done $handle] ? [dict get $done $handle] : {}}]
        if {![dict exists $steps compare]} {
            # A script made it: its own call is what does it again.
            dict set steps compare [lrange [espdiff result $handle command_line] 1 end]
        }
        set settings [lassign [dict get $steps compare] compare source target]
        # Another program's procedures are not there.
        if {[llength $settings] % 2 == 0} { set settings [dict remove $settings -command -progress] }
        lappend lines "set comparison \[espdiff compare [list $source] \\"
        lappend lines "    [list $target][settings_lines $settings]\]"
        lappend lines {puts [espdiff table $comparison]}
        dict for {what words} [dict remove $steps compare] {
            lappend lines "espdiff [lindex $words 0] \$comparison [lrange $words 1 end]"
        }
        return [join $lines \n]\n
    }

    # Options, each on a line that continues the one before.
    proc settings_lines {settings} {
        set text ""
        foreach {option value} $settings { append text " \\\n    [list $option $value]" }
        return $text
    }

    proc show_script {} {
        variable shown
        if {$shown eq ""} { error "nothing is done yet that a script could do again; press Compare first" }
        text_window script "espdiff: script of $shown" [script_text $shown]
    }
}
