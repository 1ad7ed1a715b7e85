# trajectory_run.tcl: the steps of a trajectory's run, one after the other, waited for or from the event loop.

namespace eval ::espdiff {
    # Does what can be done within so many milliseconds; returns whether the run has ended. The blocking form and the
    # one in the background both go on by this.
    proc trajectory_advance {handle milliseconds} {
        upvar #0 ::espdiff::$handle run
        if {$run(state) ne "running"} { return 1 }
        if {$run(busy)} { fail "$handle cannot be waited for from its own callback" }
        set run(busy) 1
        set code [catch { advance_step run $milliseconds } message error]
        if {![info exists run]} { return 1 }
        set run(busy) 0
        if {$run(state) eq "deleted"} { release_run run; unset run; return 1 }
        if {$code} { end_run run failed $message $error }
        return [expr {$run(state) ne "running"}]
    }

    proc advance_step {run_name milliseconds} {
        upvar 1 $run_name run
        if {$run(job) eq ""} {
            if {$run(position) >= [llength $run(steps)]} { end_run run done; return }
            if {$run(mol) ne "" && $run(mol) ni [molinfo list]} { fail "$run(where) was deleted during the run" }
            # What fails here fails as what fails in the computation does.
            if {[catch { begin_step run } message error]} { step_failed run $message $error; return }
        }
        set ended [core::wait $run(job) $milliseconds]
        report_run run
        if {!$ended || $run(state) ne "running"} return
        if {[catch { core::check $run(job) } message error]} { step_failed run $message $error; return }
        set run(failed) 0
        end_step run [step_row run [core::result $run(job)]]
    }

    proc begin_step {run_name} {
        upvar 1 $run_name run
        lassign [lindex $run(steps) $run(position)] frame reference
        set temporary {}
        set run(temporary) {}
        if {$run(reference) eq "previous"} {
            # The reference first: its map, from a user's command, may be gone when the next one is made.
            set source [frame_endpoint run $reference reference temporary]
            set target [frame_endpoint run $frame target temporary]
            set run(job) [submit temporary { core::compare $source $target $run(core_options) }]
        } else {
            set target [frame_endpoint run $frame target temporary]
            # After a frame without numbers from the source, as a run does that is resumed there.
            set start [expr {$run(failed) ? "source" : $run(start)}]
            set run(job) [submit temporary { core::series_step $run(series) $target $start }]
        }
        set run(temporary) $temporary
    }

    proc step_row {run_name result {error {}}} {
        upvar 1 $run_name run
        lassign [lindex $run(steps) $run(position)] frame reference
        if {$reference eq ""} { set reference $run(reference) }
        note_inputs run [value_or $result inputs {}]
        return [csv_row $frame $reference $result $error]
    }

    # The contents of reference and file, known after the first step only: what the rows depend on as well.
    proc note_inputs {run_name inputs} {
        upvar 1 $run_name run
        if {$run(reference) eq "previous"} return
        foreach input $inputs {
            set role [dict get $input role]
            if {!([string match source* $role] || ($role eq "target" && $run(mol) eq ""))} continue
            dict set run(about) ${role}_sha256 [dict get $input sha256]
        }
        dict for {key value} $run(head) { csv_compare $run(csv) $run(about) $key $value }
    }

    # With -on-error skip a frame that cannot be compared is a row with the error.
    proc step_failed {run_name message error} {
        upvar 1 $run_name run
        set code [dict get $error -errorcode]
        if {$run(on_error) ne "skip" || [lindex $code 0] ne "ESPDIFF" || [lindex $code 1] eq "CANCELLED"} {
            return -options $error "frame [lindex $run(steps) $run(position) 0]: $message"
        }
        incr run(skipped)
        set run(failed) 1
        end_step run [step_row run {} $message]
    }

    # Writes the row, unless it was computed again only for what comes after it, and calls the user's callback.
    proc end_step {run_name row} {
        upvar 1 $run_name run
        release_job run
        set again [expr {$run(position) < $run(written)}]
        if {$again} { compare_replay run $row } else { write_row run $row }
        incr run(position)
        if {$again || $run(callback) eq ""} return
        user_callback run $run(callback) [dict get $row frame] $row
    }

    proc write_row {run_name row} {
        upvar 1 $run_name run
        set lines {}
        if {$run(written) == 0} {
            set run(head) [csv_one_line_values $run(about)]
            set lines [csv_head $run(head)]
        }
        csv_write $run(csv) a [lappend lines [csv_line [dict values $row]]]
        incr run(written)
        incr run(rows)
        if {[saves_mappings run] && [dict get $row error] eq ""} {
            core::series_save $run(series) [state_file run] [state_fingerprint run [dict get $row frame]]
        }
    }

    # A frame that is computed again must give what the file says, or the rows would not belong together.
    proc compare_replay {run_name row} {
        upvar 1 $run_name run
        set run(replay) [lassign $run(replay) earlier]
        foreach column {rmsd_A mean_displacement_A mean_abs_difference} {
            set then [dict get $earlier $column]
            set now [dict get $row $column]
            if {$then eq $now} continue
            # Another back end's last digits may differ.
            if {[is_number $then] && [is_number $now] && abs($then - $now) <= 1e-4 * abs($then) + 1e-6} continue
            fail "-resume: frame [dict get $row frame] now has $column '$now' instead of '$then' in '$run(csv)': its\
                input has changed; -overwrite 1 begins anew"
        }
    }

    # Calls the user's progress command with the share of the whole run.
    proc report_run {run_name} {
        upvar 1 $run_name run
        set status [core::status $run(job)]
        set run(stage) "frame [lindex $run(steps) $run(position) 0]: [dict get $status stage]"
        set share [expr {($run(position) + [dict get $status fraction]) / double([llength $run(steps)])}]
        set run(fraction) [expr {max($run(fraction), $share)}]  ;# each stage of a step begins at 0 again
        if {$run(progress) ne ""} { user_callback run $run(progress) $run(stage) $run(fraction) }
    }

    # A `break` from the user's command cancels the run; it may also delete or cancel it by its handle.
    proc user_callback {run_name prefix args} {
        upvar 1 $run_name run
        switch [catch { call_user $prefix {*}$args } message error] {
            1 { return -options $error $message }
            3 { if {$run(state) eq "running"} { cancel_run run } }
        }
    }

    proc cancel_run {run_name} {
        upvar 1 $run_name run
        end_run run cancelled "cancelled after $run(written) of [llength $run(steps)] rows; -resume 1 goes on" \
            {-code 1 -level 0 -errorcode {ESPDIFF CANCELLED}}
    }

    proc end_run {run_name state {message {}} {error {}}} {
        upvar 1 $run_name run
        set run(state) $state
        set run(message) $message
        set run(error) $error
        set run(seconds) [expr {([clock milliseconds] - $run(begun)) / 1000.0}]
        if {$state eq "done"} {
            set run(fraction) 1.0
            file delete [state_file run]
        }
        release_run run
    }

    proc release_job {run_name} {
        upvar 1 $run_name run
        if {$run(job) ne "" && [exists $run(job)]} { core::delete $run(job) }
        set run(job) ""
        foreach path $run(temporary) { file delete -force $path }
        set run(temporary) {}
    }

    proc release_run {run_name} {
        upvar 1 $run_name run
        release_job run
        if {$run(series) ne "" && [exists $run(series)]} { core::delete $run(series) }
        set run(series) ""
        foreach path $run(reference_temporary) { file delete -force $path }
    }

    # From the event loop. An error of a user's command ends the run and goes to the background error handler too.
    proc trajectory_poll {handle} {
        variable slice_ms
        upvar #0 ::espdiff::$handle run
        if {![info exists run]} return
        if {![trajectory_advance $handle 0]} {
            after [expr {$run(job) eq "" ? 1 : $slice_ms}] [list ::espdiff::trajectory_poll $handle]
            return
        }
        if {![info exists run]} return
        set error $run(error)
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
            frames [llength $run(frames)] rows $run(rows) skipped $run(skipped)]
    }

    proc trajectory_check {handle} {
        upvar #0 ::espdiff::$handle run
        if {$run(state) eq "running"} {
            fail "$handle is still being computed; wait for it with `espdiff wait $handle`"
        }
        if {$run(state) ne "done"} { return -options $run(error) $run(message) }
    }

    proc trajectory_result {handle} {
        upvar #0 ::espdiff::$handle run
        trajectory_check $handle
        return [dict create frames [llength $run(frames)] rows $run(rows) skipped $run(skipped) resumed $run(resumed) \
            csv $run(csv) seconds $run(seconds)]
    }

    proc trajectory_cancel {handle} {
        upvar #0 ::espdiff::$handle run
        if {$run(state) eq "running"} { cancel_run run }
    }

    proc trajectory_delete {handle} {
        upvar #0 ::espdiff::$handle run
        release_job run
        if {$run(busy)} { set run(state) deleted; return }
        release_run run
        unset run
    }
}
