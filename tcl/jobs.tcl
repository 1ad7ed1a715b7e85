# jobs.tcl: the life of a computation: waiting, progress, the end of one in the background, cancelling, deleting.

namespace eval ::espdiff {
    # By handle: command and progress (the user's), temporary (files to delete at its end), source_mol and target_mol
    # (molecules of VMD that it came from, or empty).
    variable jobs [dict create]

    variable slice_ms 50  ;# between two looks at a computation: how long a progress bar may stand still

    # A line for the user, on VMD's console or on standard error.
    proc say {text} {
        if {[in_vmd]} { vmdcon -warn "espdiff) $text" } else { puts stderr "espdiff: $text" }
    }

    proc exists {handle} { expr {$handle in [core::handles]} }

    # Takes a computation that the core has begun under its care: waits for it, or looks after it in the background.
    proc begin_job {handle options {description {}}} {
        variable jobs
        variable slice_ms
        dict set jobs $handle [dict merge {temporary {} source_mol {} target_mol {}} $description \
            [dict create command [dict get $options command] progress [dict get $options progress]]]
        if {[dict get $options command] ne ""} {
            after $slice_ms [list ::espdiff::poll $handle]
            return $handle
        }
        if {[catch { wait_for $handle [dict get $options progress] } message error]} {
            forget_job $handle
            return -options $error $message
        }
        delete_temporary $handle
        return $handle
    }

    # Waits for the end without serving events, and throws the computation's error.
    proc wait_for {handle progress} {
        variable slice_ms
        report_progress $handle $progress
        while {![core::wait $handle $slice_ms]} { report_progress $handle $progress }
        core::check $handle
        if {$progress ne ""} { catch { call_user $progress done 1.0 } }
    }

    # Calls the user's progress command; a `break` from it cancels, an error from it as well, and is passed on.
    proc report_progress {handle progress} {
        if {$progress eq ""} return
        set status [core::status $handle]
        set code [catch { call_user $progress [dict get $status stage] [dict get $status fraction] } message options]
        if {$code == 0 || $code == 2 || $code == 4} return
        if {[exists $handle]} { core::cancel $handle }
        if {$code == 1} { return -options $options $message }
    }

    # Looks after a computation in the background. An error of a user's command goes to Tcl's background error handler,
    # as every error of an `after` script does.
    proc poll {handle} {
        variable jobs
        variable slice_ms
        if {![exists $handle] || ![dict exists $jobs $handle]} return
        set job [dict get $jobs $handle]
        if {![core::wait $handle 0]} {
            # Scheduled first, so that an error of the progress command leaves the handle looked after.
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
    }

    # Frees a handle of the core, with what hangs on it.
    proc forget_job {handle} {
        variable jobs
        if {[exists $handle]} { core::delete $handle }
        delete_temporary $handle
        dict unset jobs $handle
        forget_drawing $handle
        forget_highlight $handle
    }

    # The molecule of VMD that one side came from; empty when it came from a file or is gone.
    proc molecule_of {handle side} {
        variable jobs
        if {![in_vmd] || ![dict exists $jobs $handle]} { return "" }
        set mol [dict get $jobs $handle ${side}_mol]
        expr {$mol in [molinfo list] ? $mol : ""}
    }

    # Refuses handles that do not exist, saying which do.
    proc require_handle {handle} {
        set known [handles {}]
        if {$handle in $known} return
        if {[llength $known] == 0} { fail "there is no handle '$handle'; none exists, `espdiff compare` makes one" }
        fail "there is no handle '$handle'; there are [join_words [lsort -dictionary $known] and]"
    }

    # A trajectory's handle has no surface or table of its own.
    proc require_core_handle {handle} {
        require_handle $handle
        if {[is_trajectory $handle]} { fail "'$handle' is a trajectory; this needs a comparison or a surface" }
    }

    proc handles {options} {
        variable jobs
        set known [trajectory_handles]
        # Series and the comparisons of a trajectory's frames are not the user's.
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

    # Whether it has ended, after waiting for at most so long.
    proc finished {handle milliseconds} {
        if {[is_trajectory $handle]} { return [trajectory_advance $handle $milliseconds] }
        return [core::wait $handle $milliseconds]
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
    }
}
