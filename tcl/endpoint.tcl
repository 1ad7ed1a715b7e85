# endpoint.tcl: translates one side of a comparison, {mol ID ...} or {file PATH ...}, for the core.

namespace eval ::espdiff {
    variable endpoint_keys {
        file {file model map because unit array hetero water}
        mol {mol frame sel map because unit radii whole region}
    }

    # Parses an endpoint into a dict and reports its errors. `role` is source, target, ...
    proc parse_endpoint {text role} {
        variable endpoint_keys
        if {![string is list $text] || [llength $text] % 2 || [llength $text] == 0} {
            fail "$role: '$text' is not {mol ID ?frame N? ?sel TEXT? ?map K?} or {file PATH ?map PATH?}"
        }
        set endpoint [dict create {*}$text]
        if {![dict exists $endpoint mol] && ![dict exists $endpoint file]} {
            fail "$role: neither `mol ID` (a molecule in VMD) nor `file PATH` is in '$text'"
        }
        set form [expr {[dict exists $endpoint mol] ? "mol" : "file"}]
        foreach key [dict keys $endpoint] {
            if {$key ni [dict get $endpoint_keys $form]} {
                fail "$role: [unknown_word key $key [dict get $endpoint_keys $form]]"
            }
        }
        return $endpoint
    }

    # The endpoint for the core; appends to the caller's variable `temporary` the files to delete after the computation.
    # If the endpoint has no `map`, it is taken from `otherwise`.
    proc make_endpoint {text role temporary_name} {
        upvar 1 $temporary_name temporary
        set endpoint [parse_endpoint $text $role]
        if {[dict exists $endpoint mol]} {
            set molecule [vmd_structure $endpoint $role]
            set frame [vmd_frame [dict get $molecule mol] [value_or $endpoint frame now] $role]
            set result [vmd_with_frame $molecule $frame]
            if {[dict exists $endpoint region]} {
                dict set result region [vmd_region [dict get $molecule mol] [dict get $endpoint region] $frame $role]
            }
        } else {
            set result [file_endpoint $endpoint $role]
        }
        if {[value_or $endpoint map none] ni {none {}}} {
            dict set result map [make_map [dict get $endpoint map] $endpoint $role temporary]
        } else {
            dict set result shapes_because [value_or $endpoint because ""]
        }
        return $result
    }

    proc value_or {dict key otherwise} {
        if {[dict exists $dict $key]} { return [dict get $dict $key] }
        return $otherwise
    }

    # The full name of a file, because the core may read it from another working folder.
    proc existing_file {path what} {
        if {![file exists $path]} { fail "$what: there is no file '$path' (in [pwd])" IO }
        return [file normalize $path]
    }

    # Without `map`, `unit` and `array`, which belong to the map.
    proc file_endpoint {endpoint role} {
        set result {}
        foreach key {file model hetero water} {
            if {[dict exists $endpoint $key]} { dict set result $key [dict get $endpoint $key] }
        }
        dict set result file [existing_file [dict get $endpoint file] $role]
        return $result
    }

    # The core's map for a map as the user writes it: the number of a data set of the endpoint's molecule, a file, {file
    # PATH ?array A?}, or {mol ID map K}. `unit` and `array` may be in the endpoint or in the map.
    proc make_map {text endpoint role temporary_name} {
        upvar 1 $temporary_name temporary
        if {[is_computed $text]} {
            return [computed_map $text $endpoint "$role map" [value_or $endpoint because ""]]
        }
        set map [parse_map $text $endpoint $role]
        foreach key {unit array} {
            if {[dict exists $endpoint $key] && ![dict exists $map $key]} {
                dict set map $key [dict get $endpoint $key]
            }
        }
        if {[dict exists $map file]} {
            dict set map file [existing_file [dict get $map file] "$role map"]
            return $map
        }
        set result [vmd_take_map [dict get $map mol] [dict get $map map] $role temporary]
        if {[dict exists $map unit] && [dict get $map unit] ne ""} { dict set result unit [dict get $map unit] }
        return $result
    }

    proc parse_map {text endpoint role} {
        if {[string is list $text] && [llength $text] % 2 == 0 && [lindex $text 0] in {file mol}} {
            set map [dict create {*}$text]
            set known [expr {[dict exists $map mol] ? {mol map unit} : {file array unit}}]
            foreach key [dict keys $map] {
                if {$key ni $known} { fail "$role map: [unknown_word key $key $known]" }
            }
            if {[dict exists $map mol] && ![dict exists $map map]} { fail "$role map: `map K` is missing in '$text'" }
            return $map
        }
        if {[dict exists $endpoint mol] && [string is integer -strict $text]} {
            return [dict create mol [dict get $endpoint mol] map $text]
        }
        if {[dict exists $endpoint mol]} {
            fail "$role map: '$text' is not the number of a data set, {file PATH}, {mol ID map K}, none,\
                pb, pme or coulomb"
        }
        return [dict create file $text]
    }
}
