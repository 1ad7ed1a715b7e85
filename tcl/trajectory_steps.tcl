# trajectory_steps.tcl: a trajectory's run step by step, waited for or from the event loop, until it ends.

namespace eval ::espdiff {
    # Does what can be done within so many milliseconds; returns whether the run has ended. The blocking form and the
    # one in the background both continue by this.
    proc trajectory_advance {handle milliseconds} {
        upvar #0 ::espdiff::$handle run
        if {$run(state) ne "running"} { return 1 }
        if {$run(busy)} { fail "$handle cannot be waited for from its own callback" }
        set run(busy) 1
        set code [catch { advance_step $handle $milliseconds } message error]
        if {![info exists run]} { return 1 }
        set run(busy) 0
        if {$run(state) eq "deleted"} { release_run $handle; unset run; return 1 }
        if {$code} { end_run $handle failed $message $error }
        return [expr {$run(state) ne "running"}]
    }

    proc advance_step {handle milliseconds} {
        upvar #0 ::espdiff::$handle run
        if {!$run(in_step)} {
            set next [core::trajectory_next $handle]
            if {$next eq ""} { end_run $handle done; return }
            if {$run(mol) ne "" && $run(mol) ni [molinfo list]} { fail "$run(where) was deleted during the run" }
            if {$run(against) eq "same"} { require_sources run }
            # What fails here fails as what fails in the comparison does.
            if {[catch { begin_step $handle $next } message error]} {
                step_failed $handle $next $message $error
                end_step $handle
                return
            }
        }
        set ended [core::wait $handle $milliseconds]
        report_run $handle
        if {!$ended || $run(state) ne "running"} return
        core::check $handle
        end_step $handle
    }

    proc begin_step {handle next} {
        upvar #0 ::espdiff::$handle run
        set temporary {}
        submit temporary {
            # The reference first: its map, from a user's command, may be gone when the next one is made.
            set source {}
            if {[dict get $next source] ne ""} {
                set source [list [source_endpoint run [dict get $next source] temporary]]
            }
            set target [frame_endpoint run [dict get $next frame] target temporary]
            core::trajectory_step $handle $target {*}$source
        }
        set run(temporary) $temporary
        set run(in_step) 1
    }

    # The core writes a row with the error, or throws it. An error that is the user's own ends the run.
    proc step_failed {handle next message error} {
        set code [dict get $error -errorcode]
        if {[lindex $code 0] ne "ESPDIFF" || [lindex $code 1] eq "CANCELLED"} {
            return -options $error "frame [dict get $next frame]: $message"
        }
        core::trajectory_skip $handle $message [lindex $code 1]
    }

    proc end_step {handle} {
        upvar #0 ::espdiff::$handle run
        set run(in_step) 0
        delete_temporary_of run
        set run(summary) [core::trajectory_summary $handle]
        set row [core::trajectory_row $handle]
        if {$row ne "" && $run(callback) ne ""} { user_callback $handle $run(callback) [dict get $row frame] $row }
    }

    proc report_run {handle} {
        upvar #0 ::espdiff::$handle run
        set status [core::status $handle]
        set run(stage) [dict get $status stage]
        if {[dict get $status state] eq "running"} { set run(fraction) [dict get $status fraction] }
        if {$run(progress) ne ""} { user_callback $handle $run(progress) $run(stage) $run(fraction) }
    }

    # A `break` from the user's command cancels the run; it may also delete or cancel it by its handle.
    proc user_callback {handle prefix args} {
        upvar #0 ::espdiff::$handle run
        switch [catch { call_user $prefix {*}$args } message error] {
            1 { return -options $error $message }
            3 { if {[info exists run] && $run(state) eq "running"} { trajectory_cancel $handle } }
        }
    }

    proc trajectory_cancel {handle} {
        upvar #0 ::espdiff::$handle run
        if {$run(state) ne "running"} return
        core::cancel $handle
        while {![core::wait $handle 1000]} {}
        set run(summary) [core::trajectory_summary $handle]
        catch { core::trajectory_cancelled $handle } message error
        end_run $handle cancelled $message $error
    }

    proc end_run {handle state {message {}} {error {}}} {
        upvar #0 ::espdiff::$handle run
        set run(state) $state
        set run(message) $message
        set run(error) $error
        set run(seconds) [expr {([clock milliseconds] - $run(begun)) / 1000.0}]
        if {$state eq "done"} { set run(fraction) 1.0 }
        release_run $handle
    }

    proc delete_temporary_of {run_name} {
        upvar 1 $run_name run
        foreach path $run(temporary) { file delete -force $path }
        set run(temporary) {}
    }

    # With the core's part of it goes the lock on the file.
    proc release_run {handle} {
        upvar #0 ::espdiff::$handle run
        if {[exists $handle]} { core::delete $handle }
        delete_temporary_of run
        foreach path $run(source_temporary) { file delete -force $path }
        set run(source_temporary) {}
    }

    # From the event loop. An error of a user's command ends the run, and goes to the background error handler unless
    # somebody who waited has got it.
    proc trajectory_poll {handle} {
        variable slice_ms
        upvar #0 ::espdiff::$handle run
        if {![info exists run]} return
        if {![trajectory_advance $handle 0]} {
            after [expr {$run(in_step) ? $slice_ms : 1}] [list ::espdiff::trajectory_poll $handle]
            return
        }
        if {![info exists run]} return
        set error [expr {$run(told) ? "" : $run(error)}]
        set message $run(message)
        finally { call_user $run(command) $handle } {
            if {$error ne "" && [lindex [dict get $error -errorcode] 0] ne "ESPDIFF"} {
                after idle [list error $message [value_or $error -errorinfo $message]]
            }
        }
    }

    proc trajectory_status {handle} {
        upvar #0 ::espdiff::$handle run
        return [dict create kind trajectory state $run(state) stage $run(stage) fraction $run(fraction) \
            frames [dict get $run(summary) frames] rows [dict get $run(summary) rows] \
            skipped [dict get $run(summary) skipped]]
    }

    proc trajectory_check {handle} {
        upvar #0 ::espdiff::$handle run
        if {$run(state) eq "running"} {
            fail "$handle is still being computed; wait for it with `espdiff wait $handle`"
        }
        if {$run(state) eq "done"} return
        set run(told) 1
        return -options $run(error) $run(message)
    }

    proc trajectory_result {handle} {
        upvar #0 ::espdiff::$handle run
        trajectory_check $handle
        return [dict merge $run(summary) [list seconds $run(seconds)]]
    }

    proc trajectory_delete {handle} {
        upvar #0 ::espdiff::$handle run
        if {$run(busy)} {
            set run(state) deleted
            if {[exists $handle]} { core::cancel $handle }
            return
        }
        release_run $handle
        unset run
    }
}
