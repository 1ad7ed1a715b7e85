# trajectory.tcl: a run over the frames of a molecule in VMD, or of a file: what it is, checked before its first frame.
#
# The core has the file, its rows and the comparisons (src/trajectory); here is what knows VMD: frames, coordinates, maps,
# the user's commands, and the event loop.

namespace eval ::espdiff {
    # Each run is an array named by its handle, ::espdiff::trajectory1. What it holds:
    #   mol, file, path       the molecule, or the file whose models are the frames: as it was given, its full name
    #   endpoint              either, without frame and map
    #   structure             what vmd_structure found, for all frames
    #   frames, where         frames of the run; the molecule or file for messages
    #   reference, map, reference_map, unit, last_map       see frame_maps.tcl
    #   against               one source, previous (the frame before), or same: the frame of its number of another trajectory
    #   sources               of `same`: an array of what the other trajectory is, with the keys of this one
    #   because               why this potential, where the user named none
    #   temporary, source_temporary             files to delete after the step, and after the run
    #   in_step, busy         a frame is being compared; a step is being looked after
    #   state, message, error running, done, failed, cancelled; why
    #   told                  the error was thrown where the user waited
    #   summary, seconds, stage, fraction       how far it is

    proc trajectory {options} {
        variable slice_ms
        set handle [begin_trajectory $options]
        upvar #0 ::espdiff::$handle run
        if {$run(command) ne ""} {
            after 1 [list ::espdiff::trajectory_poll $handle]
            return $handle
        }
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
    proc begin_trajectory {options} {
        array set run {temporary {} source_temporary {} last_map {} in_step 0 busy 0 state running message {} error {}
            told 0 fraction 0 stage {} structure {} seconds 0
            because {} sources {}}
        set run(begun) [clock milliseconds]
        foreach key {mol file map unit reference command progress callback} { set run($key) [dict get $options $key] }
        set run(reference_map) [dict get $options reference-map]
        set run(on_error) [dict get $options on-error]
        if {($run(mol) eq "") == ($run(file) eq "")} {
            fail "espdiff trajectory: give one of -mol ID and -file FILE"
        }
        set run(against) [reference_kind $run(reference)]
        prepare_frames run $options
        usual_run_maps run
        check_frame_maps run
        foreach map [list $run(map) $run(reference_map)] {
            check_average $map $run(mol) [expr {$run(mol) eq "" ? 0 : [molinfo $run(mol) get numframes]}] \
                [dict get $options settings]
        }
        if {$run(against) eq "same"} { source_map run }
        set plan [trajectory_plan run $options]
        dict set plan inputs [named_files [list mol $run(mol) map $run(map)] $run(reference) $run(reference_map)]
        set handle [core::trajectory $plan [core_options $options]]
        if {[catch {
            set warning [core::trajectory_warning $handle]
            if {$warning ne ""} { say $warning }
            if {$run(against) eq "one" && [core::trajectory_next $handle] ne ""} { give_source run $handle }
            set run(summary) [core::trajectory_summary $handle]
        } message error]} {
            core::delete $handle
            return -options $error $message
        }
        array set ::espdiff::$handle [array get run]
        return $handle
    }

    proc reference_kind {reference} {
        if {$reference eq "previous"} { return previous }
        if {![string is list $reference] || [llength $reference] % 2} { return one }
        return [expr {[value_or $reference frame ""] eq "same" ? "same" : "one"}]
    }

    proc prepare_frames {run_name options} {
        upvar 1 $run_name run
        if {$run(mol) ne ""} {
            set run(mol) [vmd_molecule_id $run(mol) -mol]
            set radii [expr {[value_or [dict get $options settings] radii auto] eq "element" ? "element" : "vmd"}]
            set run(endpoint) [dict create mol $run(mol) sel [dict get $options sel] radii $radii \
                whole [dict get $options whole]]
            set run(where) "molecule $run(mol) ([molinfo $run(mol) get name])"
            vmd_frame $run(mol) last -mol
            set n [molinfo $run(mol) get numframes]
            set now [molinfo $run(mol) get frame]
        } else {
            set run(path) [existing_file $run(file) -file]
            set run(endpoint) [dict create file $run(path)]
            set run(where) "'$run(file)'"
            set n [core::models $run(path)]
            set now ""
        }
        set run(frames) [core::frames -frames [dict get $options frames] $n $now $run(where)]
        set in_frame [lindex $run(frames) 0]
        if {[lindex $run(reference) 0] eq "frame" && [llength $run(reference)] == 2} {
            set in_frame [core::frames -reference [lindex $run(reference) 1] $n $now $run(where)]
            if {[llength $in_frame] != 1} { fail "-reference: '$run(reference)' is not {frame N}" }
            set run(reference) [list frame $in_frame]
        } elseif {$run(against) eq "same"} {
            prepare_sources run $options $n
        } elseif {$run(against) eq "one"} {
            set endpoint [parse_endpoint $run(reference) -reference]
            if {[dict exists $endpoint file]} { existing_file [dict get $endpoint file] reference }
        }
        if {$run(mol) ne ""} {
            set run(structure) [vmd_structure [dict merge $run(endpoint) [list frame $in_frame]] -mol]
        }
    }

    # The other trajectory, whose frame of the same number is each frame's source.
    proc prepare_sources {run_name options n_frames} {
        upvar 1 $run_name run
        set endpoint [parse_endpoint [dict remove $run(reference) frame] -reference]
        array set sources [list mol "" file "" path "" structure {} last_map {} frames $run(frames) reference_map "" \
            unit [value_or $endpoint unit $run(unit)] endpoint $endpoint]
        if {[dict exists $endpoint mol]} {
            set sources(mol) [vmd_molecule_id [dict get $endpoint mol] -reference]
            set name "molecule $sources(mol) ([molinfo $sources(mol) get name])"
            set n [molinfo $sources(mol) get numframes]
        } else {
            set sources(file) [dict get $endpoint file]
            set sources(path) [existing_file $sources(file) -reference]
            set name "'$sources(file)'"
            set n [core::models $sources(path)]
        }
        set sources(where) $name
        if {$n != $n_frames && [dict get $options frames] eq "all"} {
            fail "-reference: $name has $n frames, and $run(where) has $n_frames; choose those of both:\
                [spelled frames] 0:[expr {min($n, $n_frames) - 1}]"
        }
        foreach frame $run(frames) {
            if {$frame >= $n} { fail "-reference: $name has no frame $frame; it has $n, from 0" }
        }
        if {$sources(mol) ne ""} {
            foreach key {sel radii whole} {
                if {![dict exists $endpoint $key] && [dict exists $run(endpoint) $key]} {
                    dict set sources(endpoint) $key [dict get $run(endpoint) $key]
                }
            }
            set first [lindex $run(frames) 0]
            set sources(structure) [vmd_structure [dict merge $sources(endpoint) [list frame $first]] -reference]
        }
        set run(sources) [array get sources]
    }

    # The run as the core takes it. What names a file is its full name: in the background the working folder may change.
    proc trajectory_plan {run_name options} {
        upvar 1 $run_name run
        # The table of residues need not exist yet.
        set plan [study_values trajectory [dict merge $options {residues ""}]]
        if {[dict get $options residues] ne ""} { dict set plan residues [file normalize [dict get $options residues]] }
        set plan [dict merge $plan [dict create csv [file normalize [dict get $options csv]] numbers $run(frames) \
            reference $run(reference) map [map_in_words $run(map) $run(unit)] \
            one_map [is_one_map $run(map) $run(mol)]]]
        if {$run(reference_map) ne $run(map)} {
            dict set plan reference_map [map_in_words $run(reference_map) $run(unit)]
        }
        dict set plan against $run(against)
        if {$run(against) eq "same"} {
            set path [dict get $run(sources) path]
            if {$path ne ""} { dict set plan source_file $path }
        }
        if {[lindex $run(reference) 0] eq "frame"} { dict set plan row_reference [lindex $run(reference) 1] }
        if {$run(against) ne "previous"} { dict set plan region [dict exists $run(reference) region] }
        if {$run(mol) eq ""} {
            dict set plan file $run(path)
        } else {
            set n_chosen [llength [dict get $run(structure) atoms]]
            dict set plan molecule [dict create \
                molecule "[molinfo $run(mol) get name], [dict get $run(structure) n_atoms] atoms" \
                sel "[dict get $options sel] ($n_chosen atoms)" radii [dict get $run(endpoint) radii]]
        }
        return $plan
    }

    # The source of all frames.
    proc give_source {run_name handle} {
        upvar 1 $run_name run
        set temporary {}
        submit temporary {
            if {[lindex $run(reference) 0] eq "frame"} {
                set source [frame_endpoint run [lindex $run(reference) 1] reference temporary]
            } else {
                set endpoint $run(reference)
                set map $run(reference_map)
                if {$map eq "" && [is_computed $run(map)]} { set map $run(map) }
                if {![dict exists $endpoint map] && $map ne ""} {
                    set endpoint [dict merge $endpoint [list map $map because $run(because)]]
                }
                if {![dict exists $endpoint unit] && $run(unit) ne ""} { dict set endpoint unit $run(unit) }
                set source [make_endpoint $endpoint reference temporary]
            }
            core::trajectory_source $handle $source
        }
        set run(source_temporary) $temporary
    }

    proc require_sources {run_name} {
        upvar 1 $run_name run
        set mol [dict get $run(sources) mol]
        if {$mol ne "" && $mol ni [molinfo list]} {
            fail "[dict get $run(sources) where] was deleted during the run"
        }
    }

    # The source of a frame in a run where each has its own.
    proc source_endpoint {run_name frame temporary_name} {
        upvar 1 $run_name run $temporary_name temporary
        if {$run(against) ne "same"} { return [frame_endpoint run $frame reference temporary] }
        array set sources $run(sources)
        set sources(map) [source_map run]
        set endpoint [frame_endpoint sources $frame reference temporary]
        unset sources(map)
        set run(sources) [array get sources]
        if {[dict exists $sources(endpoint) region] && $sources(mol) ne ""} {
            dict set endpoint region \
                [vmd_region $sources(mol) [dict get $sources(endpoint) region] $frame reference]
        }
        return $endpoint
    }

    # The rule by which frames of the other trajectory get their maps: their own, -reference-map, or a computed one.
    proc source_map {run_name} {
        upvar 1 $run_name run
        set endpoint [dict get $run(sources) endpoint]
        if {[dict exists $endpoint map]} { return [dict get $endpoint map] }
        if {$run(reference_map) ne ""} { return $run(reference_map) }
        if {$run(map) in {none ""} || [is_computed $run(map)] || [lindex $run(map) 0] eq "command"} { return $run(map) }
        fail "-map: '$run(map)' is of one trajectory; [spelled reference-map] gives the other's"
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
        dict set endpoint map [expr {[frames_in_mean $map] > 1 ? [averaged_map $run(mol) $map $frame $role]
            : [make_map $map $from $role temporary]}]
        return $endpoint
    }
}
