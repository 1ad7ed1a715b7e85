# script_words.tcl: commands of espdiff as text of a script, with variables for molecules and full names for files.

namespace eval ::espdiff {
    # The ids after `mol` in an endpoint and in its map.
    proc molecules_named {words} {
        if {![string is list $words] || [llength $words] % 2} { return {} }
        set molecules {}
        foreach {key value} $words {
            if {$key eq "mol" && $value eq "top"} { set value [molinfo top] }
            if {$key eq "mol" && [string is integer -strict $value]} { lappend molecules $value }
            if {$key eq "map"} { lappend molecules {*}[molecules_named $value] }
        }
        return $molecules
    }

    # Names that are no files (of the web) stay.
    proc full_name {path} {
        if {[file exists $path]} { return [file normalize $path] }
        return $path  ;# not by `expr`, which makes 8 of a name 010
    }

    # A molecule's word of `names`, a dict by id; otherwise its id.
    proc molecule_word {mol names} { value_or $names $mol $mol }

    # An endpoint, a variant or a map as a word of a script.
    proc script_word {words names} {
        if {![string is list $words] || [llength $words] % 2 || [lindex $words 0] ni {mol file}} {
            return [list $words]
        }
        set text "\[list"
        foreach {key value} $words {
            switch -- $key {
                mol { append text " mol [molecule_word $value $names]" }
                file { append text " file [list [full_name $value]]" }
                map {
                    append text " map [expr {[file exists $value] ? [list [full_name $value]]
                        : [script_word $value $names]}]"
                }
                default { append text " [list $key $value]" }
            }
        }
        return "$text\]"
    }

    # Options of a command as words of a script: -option word, ...
    proc script_words {options names} {
        set words {}
        foreach {option value} $options {
            switch -- $option {
                -mol { set word [molecule_word $value $names] }
                -file { set word [list [full_name $value]] }
                -reference - -map - -reference-map { set word [script_word $value $names] }
                default { set word [list $value] }
            }
            lappend words $option $word
        }
        return $words
    }
}
