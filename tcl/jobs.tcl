# jobs.tcl: computations from start to end: waiting, progress, background, cancellation, deletion.

namespace eval ::espdiff {
    # By handle: command and progress (the user's), temporary (files to delete at the end), serve (see
    # serve), source_mol and target_mol
    # (VMD's molecules, or empty), source_frame and target_frame, call (the words that began it).
    variable jobs [dict create]

    variable slice_ms 50  ;# between two polls of a computation: the longest standstill of a progress bar

    # Prints a line on VMD's console or on standard error.
    proc say {text} {
        if {[in_vmd]} { vmdcon -warn "espdiff) $text" } else { puts stderr "espdiff: $text" }
    }

    proc exists {handle} { expr {$handle in [core::handles]} }

    # Manages a computation that the core has started: waits for it, or polls it in the background.
    proc begin_job {handle options {description {}}} {
        variable jobs
        variable slice_ms
        variable call
        dict set jobs $handle [dict merge {temporary {} serve {} source_mol {} target_mol {}} $description [list call $call] \
            [dict create command [dict get $options command] progress [dict get $options progress]]]
        if {[dict get $options command] ne ""} {
            after $slice_ms [list ::espdiff::poll $handle]
            if {[dict get $jobs $handle serve] ne ""} { after 0 [list ::espdiff::serve_often $handle] }
            return $handle
        }
        if {[catch { wait_for $handle [dict get $options progress] } message error]} {
            forget_job $handle
            return -options $error $message
        }
        delete_temporary $handle
        return $handle
    }

    # Gives a computation what it needs from this thread, such as frames of VMD; it stands still until then.
    proc serve {handle} {
        variable jobs
        if {[dict exists $jobs $handle] && [dict get $jobs $handle serve] ne ""} { {*}[dict get $jobs $handle serve] }
    }

    # The same from the event loop, until it ends.
    proc serve_often {handle} {
        variable jobs
        if {![exists $handle] || ![dict exists $jobs $handle] || [core::wait $handle 0]} return
        after 5 [list ::espdiff::serve_often $handle]
        serve $handle
    }

    # Waits for the end at most so long; returns whether it has come.
    proc wait_slice {handle milliseconds} {
        variable jobs
        if {[dict get $jobs $handle serve] eq ""} { return [core::wait $handle $milliseconds] }
        set end [expr {[clock milliseconds] + $milliseconds}]
        while {![core::wait $handle 5]} {
            serve $handle
            if {[clock milliseconds] >= $end} { return 0 }
        }
        return 1
    }

    # Waits for the end without processing events, and throws the computation's error.
    proc wait_for {handle progress} {
        variable slice_ms
        report_progress $handle $progress
        while {![wait_slice $handle $slice_ms]} { report_progress $handle $progress }
        core::check $handle
        if {$progress ne ""} { catch { call_user $progress done 1.0 } }
    }

    # Calls the user's progress command. A `break` or an error from it cancels; an error is passed on.
    proc report_progress {handle progress} {
        if {$progress eq ""} return
        set status [core::status $handle]
        set code [catch { call_user $progress [dict get $status stage] [dict get $status fraction] } message options]
        if {$code == 0 || $code == 2 || $code == 4} return
        if {[exists $handle]} { core::cancel $handle }
        if {$code == 1} { return -options $options $message }
    }

    # Polls a computation in the background. Errors of a user's command go to Tcl's background error handler, like all
    # errors of `after` scripts.
    proc poll {handle} {
        variable jobs
        variable slice_ms
        if {![exists $handle] || ![dict exists $jobs $handle]} return
        set job [dict get $jobs $handle]
        if {![core::wait $handle 0]} {
            # Scheduled first, so that an error of the progress command does not stop the polling.
            after $slice_ms [list ::espdiff::poll $handle]
            report_progress $handle [dict get $job progress]
            return
        }
        delete_temporary $handle
        call_user [dict get $job command] $handle
    }

    proc delete_temporary {handle} {
        variable jobs
        if {![dict exists $jobs $handle]} return
        foreach path [dict get $jobs $handle temporary] { file delete -force $path }
        dict set jobs $handle temporary {}
        dict set jobs $handle serve {}
    }

    # Frees a handle of the core and everything that belongs to it.
    proc forget_job {handle} {
        variable jobs
        if {[exists $handle]} { core::delete $handle }
        delete_temporary $handle
        dict unset jobs $handle
        forget_drawing $handle
        forget_highlight $handle
        if {[in_vmd]} { restore_atom_colors $handle }
    }

    # The molecule of VMD of one side; empty if it came from a file or is deleted.
    proc molecule_of {handle side} {
        variable jobs
        if {![in_vmd] || ![dict exists $jobs $handle]} { return "" }
        set mol [dict get $jobs $handle ${side}_mol]
        expr {$mol in [molinfo list] ? $mol : ""}
    }

    # Refuses unknown handles, and lists the known ones.
    proc require_handle {handle} {
        set known [handles {}]
        if {$handle in $known} return
        if {[llength $known] == 0} { fail "there is no handle '$handle'; none exists, `espdiff compare` makes one" }
        fail "there is no handle '$handle'; there are [join_words [lsort -dictionary $known] and]"
    }

    # A trajectory's handle has no surface or table.
    proc require_core_handle {handle} {
        require_handle $handle
        if {[is_trajectory $handle]} { fail "'$handle' is a trajectory; this needs a comparison or a surface" }
    }

    proc handles {options} {
        variable jobs
        set known [trajectory_handles]
        # Excludes series and the comparisons of a trajectory's frames, which are internal.
        foreach handle [core::handles] { if {[dict exists $jobs $handle]} { lappend known $handle } }
        return [lsort -dictionary $known]
    }

    proc status {options handle} {
        require_handle $handle
        if {[is_trajectory $handle]} { return [trajectory_status $handle] }
        return [core::status $handle]
    }

    proc wait {options handle} {
        variable slice_ms
        require_handle $handle
        set timeout [dict get $options timeout]
        set end [expr {$timeout eq "" ? "" : [clock milliseconds] + $timeout}]
        while {![finished $handle $slice_ms]} {
            if {$end ne "" && [clock milliseconds] >= $end} { return 0 }
        }
        if {[is_trajectory $handle]} { trajectory_check $handle } else { core::check $handle }
        return 1
    }

    # Whether it has ended, after waiting at most this long.
    proc finished {handle milliseconds} {
        if {[is_trajectory $handle]} { return [trajectory_advance $handle $milliseconds] }
        return [wait_slice $handle $milliseconds]
    }

    proc cancel {options handle} {
        require_handle $handle
        if {[is_trajectory $handle]} { trajectory_cancel $handle } else { core::cancel $handle }
        return
    }

    proc delete {options args} {
        if {$args eq "all"} { set args [handles {}] }
        foreach handle $args { require_handle $handle }
        foreach handle $args {
            if {[is_trajectory $handle]} { trajectory_delete $handle } else { forget_job $handle }
        }
        if {[info commands ::espdiff::gui::notice_deleted_results] ne ""} { gui::notice_deleted_results }
    }
}
