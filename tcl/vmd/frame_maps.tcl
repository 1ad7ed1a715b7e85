# frame_maps.tcl: the potential map of each frame of a trajectory.

namespace eval ::espdiff {
    # A map as the CSV file says it, with its unit where that was given.
    proc map_in_words {map unit} {
        if {$unit eq "" || $map in {none {}} || [is_computed $map]} { return $map }
        return "$map unit $unit"
    }

    # Whether all frames get the same map.
    proc is_one_map {map mol} { expr {![is_computed $map] && [map_form $map $mol] in {number endpoint}} }

    # -map auto becomes the potential that is usual for the frames and the reference together; a reference with a map of
    # its own, or a -reference-map, leaves the frames without.
    proc usual_run_maps {run_name} {
        upvar 1 $run_name run
        if {$run(map) ne "auto"} return
        set run(map) none
        set endpoints [list $run(endpoint)]
        set is_endpoint [expr {[lindex $run(reference) 0] ne "frame" && $run(against) ne "previous"}]
        set reference $run(reference)
        if {$run(against) eq "same"} { dict unset reference frame }
        # Frames of a file take the charges of the reference where they have none.
        if {$is_endpoint && $run(mol) eq ""} { set endpoints {} }
        if {$is_endpoint} { lappend endpoints $reference }
        if {$run(reference_map) eq ""} {
            set chosen [with_usual_maps $endpoints]
            set run(map) [value_or [lindex $chosen end] map none]
            if {$is_endpoint && [dict exists $run(reference) map]} { set run(map) none }
            set run(because) [value_or [lindex $chosen end] because ""]
        }
    }

    # Checks -map before the run begins, as far as that can be done then: an error at night is an error too late.
    # `run` is the array of trajectory.tcl.
    proc check_frame_maps {run_name} {
        upvar 1 $run_name run
        set map $run(map)
        set n [llength $run(frames)]
        switch [map_form $map $run(mol)] {
            volumes {
                set first [lindex $map 1]
                if {![string is integer -strict $first] || $first < 0} {
                    fail "-map: '$map' is not {volumes K}, K a data set's number"
                }
                vmd_require_map $run(mol) [expr {$first + $n - 1}] "-map for $n frames from data set $first on"
            }
            files {
                set pattern [lindex $map 1]
                if {[catch { format $pattern 1 } one] || $one eq [format $pattern 2]} {
                    fail "-map: '$pattern' does not have one place for the frame's number, such as %d or %03d;\
                        {file PATH} is one map for all frames"
                }
                if {$run(on_error) eq "skip"} return
                foreach frame $run(frames) {
                    if {![file exists [format $pattern $frame]]} {
                        fail "-map: there is no file '[format $pattern $frame]' for frame $frame; -on-error skip goes\
                            on without such frames" IO
                    }
                }
            }
            number { vmd_require_map $run(mol) $map -map }
        }
    }

    # number, volumes, files, command, none, or endpoint for what is written as in an endpoint.
    proc map_form {map mol} {
        if {$map in {none {}}} { return none }
        if {[string is integer -strict $map]} {
            if {$mol eq ""} {
                fail "-map: '$map' is a data set's number, which needs -mol; of files use {files PATTERN}"
            }
            return number
        }
        if {[is_computed $map]} { return endpoint }
        if {[string is list $map] && [llength $map] == 2} {
            switch [lindex $map 0] {
                volumes {
                    if {$mol eq ""} { fail "-map: {volumes K} needs -mol; of files use {files PATTERN}" }
                    return volumes
                }
                files { return files }
                command { return command }
            }
        }
        if {[string is list $map] && [llength $map] % 2 == 0 && [lindex $map 0] in {file mol}} { return endpoint }
        fail "-map: '$map' is not none, K, {volumes K}, {files PATTERN}, {file PATH}, {mol ID map K}, {command PREFIX},\
            pb, pme or coulomb"
    }

    # The map of a frame as it is written in an endpoint; empty for none. What a user's command returned for a frame is
    # kept until another frame is asked for: a frame is the target first and may then be the reference.
    proc frame_map {run_name map frame} {
        upvar 1 $run_name run
        switch [map_form $map $run(mol)] {
            none { return "" }
            number { return [list mol $run(mol) map $map] }
            files { return [list file [format [lindex $map 1] $frame]] }
            volumes {
                set position [lsearch -exact $run(frames) $frame]
                if {$position < 0} {
                    fail "-map: frame $frame is not in the run, so that {volumes K} has no data set for it; give\
                        -reference-map"
                }
                return [list mol $run(mol) map [expr {[lindex $map 1] + $position}]]
            }
            command {
                if {[lindex $run(last_map) 0] ne $frame} {
                    set where [expr {$run(mol) ne "" ? $run(mol) : $run(file)}]
                    set run(last_map) [list $frame [call_user [lindex $map 1] $where $frame]]
                }
                set map [lindex $run(last_map) 1]
                if {[map_form $map $run(mol)] eq "command"} {
                    fail "-map: the command returned '$map' for frame $frame"
                }
                return [frame_map run $map $frame]
            }
        }
        return $map
    }
}
