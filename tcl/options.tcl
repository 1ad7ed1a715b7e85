# options.tcl: shared by all commands: their table, checks of arguments and options, dispatch, errors.

namespace eval ::espdiff {
    variable table [dict create]
    variable default_device auto
    variable call {}  ;# the running command, for the provenance of its result

    # Ends the calling procedure with an error; the classes are listed at the end of the manual.
    proc fail {message {class INPUT}} {
        return -code error -errorcode [list ESPDIFF $class] $message
    }

    # Evaluates `body` and then always `cleanup`, both in the caller; Tcl 8.5 has no `try`.
    proc finally {body cleanup} {
        set code [catch {uplevel 1 $body} result options]
        uplevel 1 $cleanup
        if {$code == 0} { return $result }
        dict incr options -level
        return -options $options $result
    }

    # Calls the user's command prefix at the top level. A `break` from it reaches the caller's catch.
    proc call_user {prefix args} {
        set code [catch { uplevel #0 [concat $prefix $args] } result options]
        # What Tcl makes of a `break` in the user's procedure.
        if {$code == 1 && $result eq {invoked "break" outside of a loop}} { set options {-code 3 -level 0} }
        dict incr options -level
        return -options $options $result
    }

    # A command prefix that spells the options in messages, called as PREFIX name value switch; empty for Tcl's own
    # spelling. Front ends with another spelling set it temporarily; the core reads it too.
    variable option_spelling {}

    # An option without its dash, as messages name it.
    proc spelled {name} {
        variable option_spelling
        if {$option_spelling eq ""} { return -$name }
        return [{*}$option_spelling $name "" 0]
    }

    # Adds a command to the table; commands.tcl explains the keys.
    proc command {name description} {
        variable table
        dict set table $name $description
    }

    # The rows of the core's table of a study's own options, as commands.tcl has them; of these names where they are given.
    proc study_options {study {names *}} {
        set rows {}
        foreach row [core::study_settings $study] {
            if {$names ne "*" && [dict get $row name] ni $names} continue
            dict with row { lappend rows [list -$name $kind $default $help $choices $accepts] }
        }
        return $rows
    }

    # Their values for the core.
    proc study_values {study options} {
        set values [dict create]
        foreach row [core::study_settings $study] {
            set name [dict get $row name]
            set value [dict get $options $name]
            if {[dict get $row kind] eq "file" && $value ne ""} { set value [existing_file $value -$name] }
            dict set values [string map {- _} $name] $value
        }
        return $values
    }

    proc join_words {words {last or}} {
        if {[llength $words] < 2} { return [join $words] }
        return "[join [lrange $words 0 end-1] {, }] $last [lindex $words end]"
    }

    # The words that differ from `word` by a few letters, for "did you mean".
    proc nearest {word words} {
        set best {}
        set least [expr {2 + [string length $word] / 4}]
        foreach candidate $words {
            set d [edit_distance $word $candidate]
            if {[string match "$word*" $candidate]} { set d 0 }
            if {$d < $least} { set least $d; set best {} }
            if {$d == $least} { lappend best $candidate }
        }
        return $best
    }

    # Number of letters to change, add or remove between two words.
    proc edit_distance {a b} {
        set row {}
        for {set j 0} {$j <= [string length $b]} {incr j} { lappend row $j }
        set i 0
        foreach x [split $a ""] {
            set next [list [incr i]]
            set j 0
            foreach y [split $b ""] {
                lappend next [expr {min([lindex $row $j] + ($x ne $y), [lindex $row $j+1] + 1, [lindex $next $j] + 1)}]
                incr j
            }
            set row $next
        }
        return [lindex $row end]
    }

    # "'compair' ...; did you mean compare? There are ..."
    proc unknown_word {what word words} {
        set near [nearest $word $words]
        if {[llength $near] > 0} { return "unknown $what '$word'; did you mean [join_words $near]?" }
        return "unknown $what '$word'; there are [join_words $words and]"
    }

    # All options of a command: dicts with the keys name, kind, default, help, choices, group, setting (0 or 1).
    proc options_of {name} {
        variable table
        set description [dict get $table $name]
        set options {}
        foreach option [dict get $description options] {
            lassign $option word kind default help choices accepts
            lappend options [dict create name $word kind $kind default $default help $help choices $choices \
                accepts $accepts group {} setting 0]
        }
        if {$name eq "potential"} { set options [concat $options [potential_options]] }
        set wanted [dict get $description settings]
        if {$wanted eq "none"} { return $options }
        foreach setting [core::settings] {
            if {![takes_setting $wanted $setting]} continue
            dict set setting name -[dict get $setting name]
            lappend options [dict merge $setting {setting 1}]
        }
        return $options
    }

    # Whether commands of this kind take a setting: `all`, `variants` (none of one side), `surface` and `preparation`
    # (of one molecule).
    proc takes_setting {wanted setting} {
        set name [dict get $setting name]
        switch $wanted {
            surface { return [dict get $setting surface] }
            preparation { return [dict get $setting preparation] }
            variants { return [expr {![string match source-* $name] && ![string match target-* $name]}] }
        }
        return 1
    }

    # Descriptions of the values that each kind of option accepts.
    variable kinds {
        number "a number"
        positive "a number above 0"
        integer "a whole number"
        count "a whole number of 0 or more"
        boolean "0 or 1"
        range "two numbers {LOW HIGH}, the lower one first, or auto"
        command "a Tcl command"
        text "a text"
        named "a list {NAME TEXT ...}"
        file "a file name"
        molecule "the id of a molecule in VMD, or top"
    }

    proc is_number {value} { expr {[string is double -strict $value] && ![regexp -nocase {nan|inf} $value]} }

    proc accepted_values {option} {
        variable kinds
        if {[dict get $option accepts] ne ""} { return [dict get $option accepts] }
        if {[dict get $option kind] eq "choice"} { return [join_words [dict get $option choices]] }
        return [dict get $kinds [dict get $option kind]]
    }

    # The value in the form the commands use, or an error with the accepted values.
    proc check_value {option value} {
        dict with option {}
        switch $kind {
            number { set valid [is_number $value] }
            positive { set valid [expr {[is_number $value] && $value > 0}] }
            integer { set valid [string is integer -strict $value] }
            count { set valid [expr {[string is integer -strict $value] && $value >= 0}] }
            boolean {
                set valid [string is boolean -strict $value]
                if {$valid} { set value [expr {$value ? 1 : 0}] }
            }
            range { set valid [expr {$value eq "auto" || [is_range $value]}] }
            command { set valid [string is list $value] }
            named {
                # A field may go by its kind's name.
                set valid [string is list $value]
                if {$valid && $name eq "-field" && [llength $value] == 1} { lappend value {} }
                if {$valid} { set valid [expr {[llength $value] % 2 == 0}] }
            }
            choice {
                # The core knows more about settings, such as values added by a later version, and about devices.
                set valid [expr {$value in $choices || $setting || $name eq "-device"}]
            }
            default { set valid 1 }
        }
        if {!$valid} { fail "[spelled [string range $name 1 end]]: '$value' is not [accepted_values $option]" }
        return $value
    }

    # The text as it is, once it can be read as a list.
    proc list_of {text what} {
        if {![string is list $text]} { fail "$what: '$text' is not a list (a brace or quote in it has no partner)" }
        return $text
    }

    # Pairs of words, each made into one word of the core by `body`.
    proc named_list {option form text names body} {
        if {![string is list $text] || [llength $text] % 2} { fail "$option: '$text' is not a list of $form pairs" }
        set result {}
        foreach {name value} $text { lappend result [apply [list $names $body ::espdiff] $name $value] }
        return $result
    }

    proc is_range {value} {
        if {![string is list $value] || [llength $value] != 2} { return 0 }
        lassign $value low high
        expr {[is_number $low] && [is_number $high] && $low < $high}
    }

    # "espdiff compare source target ?-option value ...?"
    proc usage {name} {
        variable table
        set usage [join [concat espdiff $name [dict get $table $name arguments]]]
        if {[llength [options_of $name]] > 0} { append usage " ?-option value ...?" }
        return $usage
    }

    proc wrong_arguments {name} {
        return -code error -errorcode {TCL WRONGARGS} "wrong # args: should be \"[usage $name]\""
    }

    # `espdiff device` sets the device for all commands.
    proc default_of {option} {
        variable default_device
        if {[dict get $option name] eq "-device"} { return $default_device }
        return [dict get $option default]
    }

    # The value of an option that was given twice: a list has both; of any other the last one counts.
    proc both_values {option first second} {
        dict with option {}
        if {$kind eq "named"} { return [concat $first $second] }
        if {$setting && $list} { return $first,$second }
        return $second
    }

    # -option value pairs as a dict of names without the dash; given settings are under `settings`. Options without a
    # default are absent unless given.
    proc parse_options {name words} {
        set options [dict create settings {}]
        set known [dict create]
        foreach option [options_of $name] {
            dict set known [dict get $option name] $option
            if {![dict get $option setting] && [dict get $option default] ne "required"} {
                dict set options [string range [dict get $option name] 1 end] [default_of $option]
            }
        }
        set given [dict create]
        while {[llength $words] > 0} {
            set words [lassign $words word]
            if {![dict exists $known $word]} { refuse_word $name $word [dict keys $known] }
            if {[llength $words] == 0} { fail "$word: its value is missing: [accepted_values [dict get $known $word]]" }
            set words [lassign $words value]
            set value [check_value [dict get $known $word] $value]
            set key [string range $word 1 end]
            if {[dict get $known $word setting]} { set key [list settings $key] }
            if {[dict exists $given $word]} { set value [both_values [dict get $known $word] [dict get $given $word] $value] }
            dict set given $word $value
            dict set options {*}$key $value
        }
        dict for {word option} $known {
            if {[dict get $option default] eq "required" && ![dict exists $options [string range $word 1 end]]} {
                fail "espdiff $name: $word is missing; it has to be given, [accepted_values $option]"
            }
        }
        return $options
    }

    # By command: earlier names that are not settings.
    variable renamed_options {draw {-transparency {-uncertain (fade, transparent or plain)}}}

    # How Tcl says what options of the command line say; empty where they are the same.
    proc instead_of {name word} {
        if {$name ni {compare matrix}} { return "" }
        if {$word in {-potential -source-map -target-map} || [regexp {^-(pb|pme)(-|$)} $word]} {
            return "a state names its own potential, such as {file A.pdb map pb} or {mol 0 map {pb ionic_strength 0.1}}"
        }
        if {$word in {-o -output}} { return "the command returns a result, which espdiff export writes to files" }
        return ""
    }

    # Options cannot be abbreviated: a new option would break such scripts.
    proc refuse_word {name word known} {
        if {![string match -* $word]} { return -code error -errorcode {TCL WRONGARGS} \
            "wrong # args: should be \"[usage $name]\"" }
        variable renamed_options
        if {[dict exists $renamed_options $name $word]} {
            fail "espdiff $name: $word is called [dict get $renamed_options $name $word] now"
        }
        set renamed [core::renamed_settings]
        set old [string range $word 1 end]
        if {[dict exists $renamed $old] && "-[dict get $renamed $old]" in $known} {
            fail "espdiff $name: $word is called -[dict get $renamed $old] now"
        }
        set instead [instead_of $name $word]
        if {$instead ne ""} { fail "espdiff $name: no option $word in Tcl: $instead" }
        fail "espdiff $name: [unknown_word option $word $known]"
    }

    # Runs a command of the table; called by the ensemble ::espdiff.
    proc run {name args} {
        variable table
        variable call
        set description [dict get $table $name]
        if {[lindex $args 0] eq "-help" || [lindex $args end] eq "-help"} { return [help_text $name] }
        set least 0
        set most 0
        foreach argument [dict get $description arguments] {
            if {![string match {\?*} $argument]} { incr least }
            if {[string match "*...*" $argument]} { set most 1000000 } else { incr most }
        }
        set n_options [llength [options_of $name]]
        if {$n_options == 0 && [string match -* [lindex $args 0]]} {
            fail "espdiff $name: it has no options, not '[lindex $args 0]'; \"[usage $name]\""
        }
        set n [expr {$n_options > 0 ? $least : [llength $args]}]
        if {$n < $least || $n > $most || [llength $args] < $n} { wrong_arguments $name }
        set positional [lrange $args 0 [expr {$n - 1}]]
        foreach argument $positional {
            if {$n_options > 0 && [string match {-[a-z]*} $argument]} { wrong_arguments $name }
        }
        set call [concat [list espdiff $name] $args]
        [dict get $description run] [with_given_fields [parse_options $name [lrange $args $n end]]] {*}$positional
    }

    # By command: the fields of VMD's atoms that its molecules are to bring, such as user.
    variable given_fields {}

    # Options whose fields are complete: a word that is no kind but a keyword of VMD's selections is a field of VMD's
    # atoms, `user` is given:user.
    proc with_given_fields {options} {
        variable given_fields
        set given_fields {}
        set settings [dict get $options settings]
        if {![dict exists $settings field] || [catch { dict get $settings field } list]} { return $options }
        set fields {}
        foreach {name kind} $list {
            if {$kind eq ""} { set kind $name }
            if {[in_vmd] && $kind ni [core::field_kinds] && $kind in [atomselect keywords]} { set kind given:$kind }
            if {[string match given:?* $kind]} { lappend given_fields [string range $kind 6 end] }
            lappend fields $name $kind
        }
        dict set options settings field $fields
        return $options
    }

    # Called by the ensemble for an unknown subcommand.
    proc unknown_command {ensemble name args} {
        variable table
        fail "espdiff: [unknown_word command $name [dict keys $table]]; `espdiff help` explains them"
    }

    proc make_ensemble {} {
        variable table
        set map [dict create]
        dict for {name description} $table { dict set map $name [list ::espdiff::run $name] }
        namespace ensemble create -command ::espdiff -map $map -prefixes 0 -unknown ::espdiff::unknown_command
    }
}
