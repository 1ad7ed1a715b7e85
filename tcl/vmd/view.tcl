# view.tcl: starts the viewer, a separate program, on a comparison in memory or in files.

namespace eval ::espdiff {
    # The command line's program: beside the package as built or installed, or on PATH; empty if there is none.
    proc program_path {} {
        variable directory
        if {[info exists ::env(ESPDIFF_PROGRAM)] && $::env(ESPDIFF_PROGRAM) ne ""} { return $::env(ESPDIFF_PROGRAM) }
        foreach up {{.. .. ..} {.. ..}} {
            set path [file normalize [file join $directory {*}$up bin espdiff]]
            if {[file executable $path] && ![file isdirectory $path]} { return $path }
        }
        return [lindex [auto_execok espdiff] 0]
    }

    proc view {options input} {
        set program [program_path]
        if {$program eq ""} {
            fail "espdiff view: the program espdiff is not found; install it whole (cmake --install BUILD), put it on\
                PATH, or name it in the environment variable ESPDIFF_PROGRAM" IO
        }
        if {![string is list [dict get $options arguments]]} { fail "-arguments: not a list" }
        set prefix [dict get $options output]
        set log [temporary_file .log]
        set folder [temporary_folder]
        if {[catch {
            if {[string match *.vtp $input]} {
                set surface [existing_file $input "espdiff view"]
            } else {
                set surface [export_for_viewer $folder $input]
            }
            if {$prefix eq ""} { set prefix [file join [pwd] [file rootname [file tail $surface]]-view] }
            # The shell cleans up when the viewer has ended, since VMD may have exited by then.
            set script {
                trap : HUP INT TERM
                folder=$1 log=$2
                shift 2
                "$@"
                status=$?
                rm -rf "$folder"
                [ $status = 0 ] && rm -f "$log"
                exit $status
            }
            set process [core::start_program [list /bin/sh -c $script espdiff-view $folder $log \
                $program view $surface -o $prefix --layout [dict get $options layout] \
                {*}[dict get $options arguments]] $log]
            # Errors of display or options appear at once.
            for {set i 0} {$i < 10} {incr i} {
                after 50
                if {[viewer_has_ended $process $log]} break
            }
        } message error]} {
            file delete -force $folder
            file delete $log
            return -options $error $message
        }
        if {[file exists $log]} { after 1000 [list ::espdiff::watch_viewer $process $log] }
        return $process
    }

    # A new folder that only the user can enter.
    proc temporary_folder {} { core::private_folder [file join [temporary_place] espdiff-[pid]-view-] }

    proc export_for_viewer {folder handle} {
        require_core_handle $handle
        set status [core::status $handle]
        if {[dict get $status kind] ne "comparison"} {
            fail "espdiff view: $handle is a [dict get $status kind]; the viewer shows comparisons"
        }
        core::export $handle [file join $folder $handle] 1 0
        return [file join $folder $handle.vtp]
    }

    # Whether it has ended; if it failed, an error with the viewer's message.
    proc viewer_has_ended {process log {name "the viewer"}} {
        set state [core::program_state $process]
        if {$state eq "running"} { return 0 }
        if {$state in {0 ""}} {
            file delete $log
            return 1
        }
        set words "it ended with status $state and gave no reason"
        if {![catch { open_file $log } channel]} {
            set text [string trim [read $channel]]
            close $channel
            if {![regexp -line {^espdiff: (.*)$} $text all words] && $text ne ""} {
                set words [lindex [split $text \n] end]
            }
        }
        file delete $log
        fail "$name: $words" DEVICE
    }

    # Polls until it has ended.
    proc watch_viewer {process log} {
        if {[catch { viewer_has_ended $process $log } over]} {
            viewer_failed $over
        } elseif {!$over} {
            after 1000 [list ::espdiff::watch_viewer $process $log]
        }
    }

    proc viewer_failed {message} {
        if {[info commands ::espdiff::gui::show_message] ne ""} { gui::show_message $message error; return }
        if {[in_vmd]} { vmdcon -err "espdiff) $message" } else { puts stderr "espdiff: $message" }
    }
}
