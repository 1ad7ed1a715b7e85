# manual.tcl: makes help texts and the manual's second part from the table of commands.

namespace eval ::espdiff {
    # A paragraph of the table as one line.
    proc one_line {text} { join [regexp -all -inline {\S+} $text] }

    # Wraps a paragraph to lines of at most `width` letters, each after `indent`.
    proc wrapped {text indent {width 100}} {
        set lines {}
        set line ""
        foreach word [regexp -all -inline {\S+} $text] {
            if {$line ne "" && [string length "$indent$line $word"] > $width} {
                lappend lines $indent$line
                set line ""
            }
            append line [expr {$line eq "" ? "" : " "}] $word
        }
        return [join [lappend lines $indent$line] \n]
    }

    # "number, default 1.0"
    proc describe_option {option} {
        set accepted [accepted_values $option]
        set default [dict get $option default]
        if {$default eq "required"} { return "$accepted, has to be given" }
        if {$default eq ""} { return $accepted }
        return "$accepted, default $default"
    }

    proc help {options {name {}}} {
        variable table
        if {$name ne ""} {
            if {![dict exists $table $name]} {
                fail "espdiff help: [unknown_word command $name [dict keys $table]]"
            }
            return [help_text $name]
        }
        set text "espdiff [core::version]: where does the surface potential of two states of a molecule differ?\n"
        dict for {command description} $table {
            append text [format "\n  espdiff %-11s %s" $command [first_sentence [dict get $description summary]]]
        }
        return "$text\n\n`espdiff help COMMAND` explains one."
    }

    proc first_sentence {text} {
        set text [one_line $text]
        set end [string first ". " $text]
        expr {$end < 0 ? $text : [string range $text 0 $end]}
    }

    proc help_text {name} {
        variable table
        set description [dict get $table $name]
        set text "[usage $name]\n\n[wrapped [dict get $description summary] {  }]\n\n"
        append text "[wrapped "Returns [dict get $description returns]." {  }]\n"
        set group ""
        foreach option [options_of $name] {
            if {[dict get $option group] ne $group || $group eq ""} {
                if {$group eq "" && ![string match "*\n  Options:\n*" $text] && [dict get $option group] eq ""} {
                    append text "\n  Options:\n"
                } elseif {[dict get $option group] ne $group} {
                    set group [dict get $option group]
                    append text "\n  $group:\n"
                }
            }
            append text [format "    %-30s %s\n" [dict get $option name] [describe_option $option]]
            append text [wrapped [dict get $option help] "        "]\n
        }
        append text "\n  Example:\n    [dict get $description example]"
        return $text
    }

    # The second part of docs/tcl.md.
    proc manual {} {
        variable table
        set text ""
        dict for {name description} $table { append text [manual_of $name $description] }
        return "$text[manual_of_settings]\n[manual_of_metrics]"
    }

    proc manual_of {name description} {
        set text "### $name\n\n    [usage $name]\n\n[wrapped [dict get $description summary] {} 100]\n\n"
        append text "[wrapped "Returns [dict get $description returns]." {} 100]\n\n"
        set rows {}
        foreach option [options_of $name] {
            if {![dict get $option setting]} { lappend rows $option }
        }
        append text [manual_options $rows]
        switch [dict get $description settings] {
            all { append text "Takes all [link_to_settings] as well.\n\n" }
            variants { append text "Takes all [link_to_settings] but those of one side as well.\n\n" }
            surface { append text "Takes those [link_to_settings] that are marked *surface* as well.\n\n" }
            preparation { append text "Takes those [link_to_settings] that are marked *prepare* as well.\n\n" }
        }
        return "${text}Example:\n\n    [dict get $description example]\n\n"
    }

    proc link_to_settings {} { return {[settings](#settings)} }

    proc manual_options {rows} {
        if {[llength $rows] == 0} { return "" }
        set text "| option | accepts | meaning |\n|---|---|---|\n"
        foreach option $rows {
            set cells [list `[dict get $option name]` [describe_option $option] [one_line [dict get $option help]]]
            append text "| [join [string map {| \\|} $cells] { | }] |\n"
        }
        return "$text\n"
    }

    proc manual_of_settings {} {
        set text "### Settings\n\nOptions of `compare`, `surface` and `trajectory`; the command line has the same.\n"
        set group ""
        foreach setting [core::settings] {
            if {[dict get $setting group] ne $group} {
                set group [dict get $setting group]
                append text "\n*$group*\n\n| option | accepts | meaning | |\n|---|---|---|---|\n"
            }
            set mark [join [concat [expr {[dict get $setting surface] ? "surface" : ""}] \
                [expr {[dict get $setting preparation] ? "prepare" : ""}]] ", "]
            set cells [list `-[dict get $setting name]` [describe_option $setting] [dict get $setting help] $mark]
            append text "| [join $cells { | }] |\n"
        }
        return $text
    }
}
