# session_script.tcl: the actions in the window as a Tcl script.

namespace eval ::espdiff::gui {
    # By handle and action (compare, draw, map.QUANTITY.MOL, export): the words after `espdiff` without the handle.
    # Repeating an action replaces it, as in VMD.
    variable done [dict create]
    # By molecule of VMD: the lines that load it again.
    variable loading [dict create]
    # By handle, and for `trajectory`, `matrix` and `ensemble`: the molecules of VMD that they need.
    variable needed [dict create]
    variable prepared [dict create]  ;# by PQR file: the words after `espdiff` that made it

    proc remember_compare {handle source target settings} {
        variable done
        dict set done $handle [dict create compare [concat compare [list $source $target] $settings]]
        remember_molecules $handle [list $source $target]
    }

    # Recorded now, since the user may delete a molecule later. Ids change from session to session, so that the script
    # has variables instead: $mol0 for what is molecule 0 here.
    proc remember_molecules {what endpoints} {
        variable loading
        variable needed
        set molecules {}
        foreach endpoint $endpoints { lappend molecules {*}[::espdiff::molecules_named $endpoint] }
        foreach mol $molecules { if {$mol in [molinfo list]} { dict set loading $mol [how_loaded $mol] } }
        dict set needed $what [lsort -integer -unique $molecules]
    }

    proc remember {handle what words} {
        variable done
        dict set done $handle $what $words
    }

    # Removes an undone action; without `what` all actions of a handle.
    proc forget {handle {what ""}} {
        variable done
        variable needed
        if {$what eq ""} {
            dict unset done $handle
            dict unset needed $handle
        } elseif {[dict exists $done $handle $what]} {
            dict unset done $handle $what
        }
    }

    # The commands that load a molecule as VMD did, by full names, for any working folder.
    proc how_loaded {mol} {
        lassign [molinfo $mol get {filename filetype filespec}] paths types specs
        set lines {}
        foreach path $paths type $types spec $specs {
            if {$type eq "espdiffmap"} {
                lappend lines "# Molecule $mol also had a map that espdiff computed in VMD."
                continue
            }
            lappend lines {*}[how_prepared $path]
            set words [list [::espdiff::full_name $path] type $type {*}$spec waitfor all]
            if {![string match "*mol new*" $lines]} {
                lappend lines "set mol$mol \[mol new $words\]"
            } else {
                lappend lines "mol addfile $words \$mol$mol"
            }
        }
        # Frames that were deleted or added by hand are in no file.
        set n [molinfo $mol get numframes]
        lappend lines "if {\[molinfo \$mol$mol get numframes\] != $n} { error \"molecule $mol had $n frames when it was\
            compared, and its files have \[molinfo \$mol$mol get numframes\]; save its frames as a file\
            (File > Save Coordinates), load that instead, and compare again\" }"
        return $lines
    }

    proc how_prepared {path} {
        variable prepared
        if {![dict exists $prepared $path]} { return {} }
        set made [string map {\n \\n \r \\r} [dict get $prepared $path]]
        return [list "# The next file was made by: espdiff $made"]
    }

    # By molecule: its variable in the script.
    proc molecule_variables {} {
        variable loading
        set names [dict create]
        foreach mol [dict keys $loading] { dict set names $mol \$mol$mol }
        return $names
    }

    proc script_word {words} { ::espdiff::script_word $words [molecule_variables] }
    proc script_words {options} { ::espdiff::script_words $options [molecule_variables] }

    # A script that repeats from nothing what was done in the window: the shown comparison with its drawing, the
    # trajectory, the matrix, the ensemble.
    proc session_text {} {
        variable shown
        variable needed
        variable loading
        remember_script_molecules $shown
        set molecules {}
        foreach what [list $shown trajectory matrix ensemble] {
            if {[dict exists $needed $what]} { lappend molecules {*}[dict get $needed $what] }
        }
        set lines {"package require espdiff"}
        foreach mol [lsort -integer -unique $molecules] {
            if {[dict exists $loading $mol]} { lappend lines {*}[dict get $loading $mol] }
        }
        lappend lines {*}[pair_lines $shown] {*}[trajectory_lines] {*}[matrix_lines] \
            {*}[ensemble_lines]
        return [join $lines \n]\n
    }

    # A comparison that a script made: its own call repeats it.
    proc remember_script_molecules {handle} {
        variable done
        if {$handle eq "" || ([dict exists $done $handle] && [dict exists $done $handle compare])} return
        set call [lrange [espdiff result $handle command_line] 1 end]
        dict set done $handle compare $call
        if {[in_vmd]} { remember_molecules $handle [lrange $call 1 2] }
    }

    proc pair_lines {handle} {
        variable done
        if {$handle eq ""} { return {} }
        set steps [dict get $done $handle]
        set settings [lassign [dict get $steps compare] compare source target]
        # Callbacks of another program are not available.
        if {[llength $settings] % 2 == 0} { set settings [dict remove $settings -command -progress] }
        foreach endpoint [list $source $target] {
            if {[dict exists $endpoint file]} { lappend lines {*}[how_prepared [dict get $endpoint file]] }
        }
        lappend lines "set comparison \[espdiff compare [script_word $source] \\"
        lappend lines "    [script_word $target][option_lines $settings]\]"
        lappend lines {puts [espdiff table $comparison]}
        dict for {what words} [dict remove $steps compare] {
            set options [lassign $words name]
            set first {}
            # Positional words come before the options.
            while {[llength $options] % 2 || ($options ne "" && ![string match {-[a-z]*} [lindex $options 0]])} {
                set options [lassign $options word]
                lappend first [list $word]
            }
            lappend lines [string trimright "espdiff $name \$comparison [join [concat $first [script_words $options]]]"]
        }
        return $lines
    }

    # The name of a result's repetition: beside the result, not over it.
    proc beside {path} { return "[file rootname $path]-repeated[file extension $path]" }

    # The run whose rows are shown, from its first frame.
    proc trajectory_lines {} {
        variable trajectory_run
        if {$trajectory_run eq ""} { return {} }
        set csv [dict get $trajectory_run output -csv]
        set output [dict create {*}[dict get $trajectory_run output] -csv [beside $csv]]
        if {[dict exists $output -residues]} { dict set output -residues [beside [dict get $output -residues]] }
        set options [concat [dict get $trajectory_run options] $output {-overwrite 1} \
            [dict get $trajectory_run settings]]
        set lines [list "puts \[espdiff trajectory[option_lines $options]\]"]
        if {[dict exists $trajectory_run plot]} {
            set plot [dict create {*}[dict get $trajectory_run plot]]
            dict set plot -file [beside [dict get $plot -file]]
            lappend lines "espdiff plot [list [beside $csv]] $plot -overwrite 1"
        }
        return $lines
    }

    proc matrix_lines {} {
        variable matrix_run
        if {$matrix_run eq ""} { return {} }
        dict with matrix_run {
            set text "set variants \[list"
            foreach variant $variants { append text " \\\n    [script_word $variant]" }
            set through [expr {$template eq "" ? {} : [list -template $template]}]
            return [list "$text\]" \
                "puts \[espdiff table \[espdiff matrix \$variants[option_lines \
                    [concat [list -output [beside $output] -overwrite 1] $through $settings]]\]\]"]
        }
    }

    proc ensemble_lines {} {
        variable ensemble_run
        variable done
        if {$ensemble_run eq ""} { return {} }
        dict with ensemble_run {
            set text "set groups \[list"
            foreach {group list} $groups {
                append text " \\\n    [list $group] \[list"
                foreach replicate $list { append text " [script_word $replicate]" }
                append text "\]"
            }
            set lines [list "$text\]" "set ensemble \[espdiff ensemble \$groups[option_lines \
                [concat [dict merge $options [list -output [beside [dict get $options -output]]]] {-overwrite 1}\
                $settings]]\]" {puts [espdiff table $ensemble]}]
        }
        if {[dict exists $done ensemble draw]} {
            lappend lines "espdiff draw \$ensemble [lrange [dict get $done ensemble draw] 1 end]"
        }
        return $lines
    }

    # Options, each on a continuation line.
    proc option_lines {options} {
        set text ""
        foreach {option word} [script_words $options] { append text " \\\n    $option $word" }
        return $text
    }

    proc show_script {} {
        variable shown
        variable trajectory_run
        variable matrix_run
        variable ensemble_run
        if {$shown eq "" && $trajectory_run eq "" && $matrix_run eq "" && $ensemble_run eq ""} {
            error "nothing has been done yet that a script could repeat; press Compare first"
        }
        text_window script "espdiff: script of this session" [session_text]
    }
}
