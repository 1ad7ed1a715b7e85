# trajectory.tcl: each frame of a trajectory against a reference or the frame before it, row by row into a CSV file.

namespace eval ::espdiff {
    # Each run is an array named by its handle, ::espdiff::trajectory1. What it holds:
    #   mol, file, endpoint   the molecule, or the file whose models are the frames; the endpoint without frame and map
    #   structure             what vmd_structure found, for all frames
    #   frames, steps         frames of the run; {frame reference} of each step
    #   map, reference_map, last_map, about       see frame_maps.tcl; what the CSV file says of the run
    #   series, job, temporary, reference_temporary  handles of the core, and files to delete
    #   head                  what the file says of itself, as `about`
    #   position, written     step that is next; rows in the file
    #   rows, skipped         rows written by this run, and how many of them say why they have no numbers
    #   replay                rows of the file that are computed again, from the one at `position` on
    #   state, message, error                     running, done, failed, cancelled; why
    variable n_trajectories 0

    proc trajectory {options} {
        variable n_trajectories
        set handle trajectory[incr n_trajectories]
        upvar #0 ::espdiff::$handle run
        if {[catch { prepare_run run $options } message error]} {
            release_run run
            unset run
            return -options $error $message
        }
        if {$run(command) ne ""} {
            after 1 [list ::espdiff::trajectory_poll $handle]
            return $handle
        }
        variable slice_ms
        while {![trajectory_advance $handle $slice_ms]} {}
        finally {
            trajectory_check $handle
            trajectory_result $handle
        } { trajectory_delete $handle }
    }

    proc trajectory_handles {} {
        set handles {}
        foreach name [info vars ::espdiff::trajectory*] { lappend handles [namespace tail $name] }
        return $handles
    }

    proc is_trajectory {handle} { expr {$handle in [trajectory_handles]} }

    # Everything that can be checked before the first frame is checked here.
    proc prepare_run {run_name options} {
        upvar 1 $run_name run
        array set run {series {} job {} temporary {} reference_temporary {} last_map {} position 0 rows 0 skipped 0
            replay {} head {} written 0 state running message {} error {} busy 0 fraction 0 stage {} structure {}
            failed 0}
        set run(begun) [clock milliseconds]
        foreach key {mol file map csv start unit command progress callback} { set run($key) [dict get $options $key] }
        set run(csv) [file normalize $run(csv)]  ;# in the background the working folder may change
        set run(reference_map) [dict get $options reference-map]
        set run(on_error) [dict get $options on-error]
        if {$run(mol) eq "" && $run(file) eq "" || $run(mol) ne "" && $run(file) ne ""} {
            fail "espdiff trajectory: give one of -mol ID and -file FILE"
        }
        prepare_frames run $options
        usual_run_maps run options
        check_frame_maps run
        set run(core_options) [core_options $options]
        if {$run(start) eq "auto"} { set run(start) [usual_start $run(core_options)] }
        set run(about) [about_run run [dict replace $options start $run(start)]]
        lassign [csv_open $run(csv) [dict get $options resume] [dict get $options overwrite] $run(about)] \
            earlier run(head)
        set run(written) [llength $earlier]
        set run(resumed) $run(written)
        go_on_after run $earlier
    }

    proc prepare_frames {run_name options} {
        upvar 1 $run_name run
        if {$run(mol) ne ""} {
            set run(mol) [vmd_molecule_id $run(mol) -mol]
            set run(endpoint) [dict create mol $run(mol) sel [dict get $options sel] radii [dict get $options radii]]
            set run(where) "molecule $run(mol) ([molinfo $run(mol) get name])"
            vmd_frame $run(mol) last -mol
            set n [molinfo $run(mol) get numframes]
            set now [molinfo $run(mol) get frame]
        } else {
            set run(endpoint) [dict create file $run(file)]
            set run(where) "'$run(file)'"
            set n [number_of_models $run(file)]
            set now 0
        }
        set run(frames) [parse_frames [dict get $options frames] $n $now $run(where)]
        set run(reference) [dict get $options reference]
        set in_frame [lindex $run(frames) 0]
        if {[lindex $run(reference) 0] eq "frame" && [llength $run(reference)] == 2} {
            set in_frame [parse_frames [lindex $run(reference) 1] $n $now $run(where)]
            if {[llength $in_frame] != 1} { fail "-reference: '$run(reference)' is not {frame N}" }
            set run(reference) [list frame $in_frame]
        } elseif {$run(reference) ne "previous"} {
            parse_endpoint $run(reference) -reference
        }
        if {$run(mol) ne ""} {
            set run(structure) [vmd_structure [dict merge $run(endpoint) [list frame $in_frame]] -mol]
        }
        set run(steps) [steps_of run]
    }

    proc steps_of {run_name} {
        upvar 1 $run_name run
        set steps {}
        set before ""
        set fixed ""
        if {[lindex $run(reference) 0] eq "frame"} { set fixed [lindex $run(reference) 1] }
        foreach frame $run(frames) {
            if {$run(reference) ne "previous"} {
                lappend steps [list $frame $fixed]
            } elseif {$before ne ""} {
                lappend steps [list $frame $before]
            }
            set before $frame
        }
        if {[llength $steps] == 0} { fail "-reference previous needs two frames or more" }
        return $steps
    }

    # What the rows depend on: a file is gone on with only where all of it is the same.
    proc about_run {run_name options} {
        upvar 1 $run_name run
        set about [dict create espdiff [core::version]]
        if {$run(mol) ne ""} {
            dict set about molecule "[molinfo $run(mol) get name], [dict get $run(structure) n_atoms] atoms"
            dict set about sel "[dict get $options sel] ([llength [dict get $run(structure) atoms]] atoms)"
            dict set about radii [dict get $options radii]
        } else {
            dict set about file "[file tail $run(file)], [file size $run(file)] bytes"
        }
        foreach key {frames reference map reference-map unit start settings} {
            dict set about $key [dict get $options $key]
        }
        return $about
    }

    # Sets the step to begin with after the rows that the file has.
    proc go_on_after {run_name earlier} {
        upvar 1 $run_name run
        set position 0
        foreach row $earlier step $run(steps) {
            if {$row eq ""} break
            lassign $step frame
            if {$step eq "" || [dict get $row frame] ne $frame} {
                set where [expr {$step eq "" ? "beyond the run" : "not of $frame"}]
                fail "-csv: row [expr {$position + 1}] of '$run(csv)' is of frame [dict get $row frame], $where;\
                    -overwrite 1 begins anew"
            }
            incr position
        }
        set run(position) $position
        if {$position == 0} { file delete [state_file run] }
        if {$position == [llength $run(steps)]} return
        if {$run(reference) ne "previous"} { begin_series run }
        if {$position > 0} { restore_mapping run $earlier }
    }

    # A mapping that begins at the frame before needs that frame's: each row is followed by a file with it, so that a
    # resumed run gives the same bits as one that was not interrupted.
    proc state_file {run_name} {
        upvar 1 $run_name run
        return $run(csv).state
    }

    # What the mapping in that file belongs to: the CSV file's head, and the frame.
    proc state_fingerprint {run_name frame} {
        upvar 1 $run_name run
        return [one_line "frame $frame $run(head)"]
    }

    # Where mappings begin unless the user says.
    proc usual_start {core_options} {
        set usual [expr {[value_or $core_options thesis 0] ? "deform" : "morph"}]
        expr {[value_or $core_options method $usual] eq "deform" ? "previous" : "source"}
    }

    proc saves_mappings {run_name} {
        upvar 1 $run_name run
        expr {$run(start) eq "previous" && $run(series) ne ""}
    }

    # Whether the frame after this row's may begin at its mapping; else, and without a row, at the source.
    proc has_mapping {row} { expr {$row ne "" && [dict get $row error] eq "" && [dict get $row converged]} }

    proc restore_mapping {run_name earlier} {
        upvar 1 $run_name run
        set last [lindex $earlier end]
        if {![saves_mappings run] || ![has_mapping $last]} return
        if {![catch { restore_mapping_of run $last } reason]} return
        # An interruption between a row and its mapping leaves the mapping before: that row is then computed again.
        set before [lindex $earlier end-1]
        if {![has_mapping $before] || ![catch { restore_mapping_of run $before }]} {
            set run(replay) [list $last]
            incr run(position) -1
            return
        }
        set frame [dict get $last frame]
        say "-resume: the mapping of frame $frame is missing, the next one begins at the source: $reason"
    }

    proc restore_mapping_of {run_name row} {
        upvar 1 $run_name run
        core::series_restore $run(series) [state_file run] [state_fingerprint run [dict get $row frame]]
    }

    proc begin_series {run_name} {
        upvar 1 $run_name run
        set temporary {}
        set endpoint $run(reference)
        if {[lindex $endpoint 0] eq "frame"} {
            set source [frame_endpoint run [lindex $endpoint 1] reference temporary]
        } else {
            if {![dict exists $endpoint map] && $run(reference_map) ne ""} { dict set endpoint map $run(reference_map) }
            if {![dict exists $endpoint unit] && $run(unit) ne ""} { dict set endpoint unit $run(unit) }
            set source [make_endpoint $endpoint reference temporary]
        }
        set run(reference_temporary) $temporary
        set run(series) [submit temporary { core::series $source $run(core_options) }]
    }

    # A frame of the trajectory with its map as the core's endpoint.
    proc frame_endpoint {run_name frame role temporary_name} {
        upvar 1 $run_name run $temporary_name temporary
        if {$run(mol) ne ""} {
            set endpoint [vmd_with_frame $run(structure) $frame]
        } else {
            set endpoint [file_endpoint [dict merge $run(endpoint) [list model [expr {$frame + 1}]]] $role]
        }
        set map $run(map)
        if {$role eq "reference" && $run(reference_map) ne ""} { set map $run(reference_map) }
        set map [frame_map run $map $frame]
        if {$map eq ""} { return $endpoint }
        set from $run(endpoint)
        if {$run(unit) ne ""} { dict set from unit $run(unit) }
        if {$run(mol) ne ""} { dict set from frame $frame }
        dict set endpoint map [make_map $map $from $role temporary]
        return $endpoint
    }
}
