# interrupted.tcl: what a user may do during a run, and inputs that are easy to get wrong: frames deleted, `break`, molecules cut by their cell.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

set background {}
proc background_error {message options} { lappend ::background $message }
interp bgerror {} background_error

proc load_adk {} {
    set mol [mol new [input traj_adk/adk.psf] type psf waitfor all]
    mol addfile [input traj_adk/adk_dims.dcd] type dcd first 0 last 19 waitfor all $mol
    return $mol
}
set adk [load_adk]
set quick {-grid-spacing 2}

test "frames that are deleted during a run in the background are told once, in our words" {
    set run [espdiff trajectory -mol $adk -sel protein -frames 0:1:end -map pme -csv $scratch/gone.csv {*}$quick -command list]
    after 300 { animate delete beg 5 end 19 $adk }
    set end [expr {[clock seconds] + 60}]
    while {[dict get [espdiff status $run] state] eq "running"} {
        after 50 {set ::tick 1}
        vwait ::tick
        check "in time" {[clock seconds] < $end}
    }
    check_refused { espdiff wait $run } {ESPDIFF INPUT} "frame 5" "not there any more; 5 are left"
    update
    after 100 {set ::tick 1}
    vwait ::tick
    check_equal "background errors" $background {}
    espdiff delete $run
}

test "the same waited for" {
    set again [load_adk]
    set run [espdiff trajectory -mol $again -sel protein -frames 0:1:end -map none -csv $scratch/gone2.csv {*}$quick -command list]
    after 200 { animate delete beg 3 end 19 $again }
    after 250 {set ::tick 1}
    vwait ::tick
    check_refused { espdiff wait $run } {ESPDIFF INPUT} "not there any more"
    update
    check_equal "background errors" $background {}
    espdiff delete $run
    mol delete $again
}

test "break in a callback cancels" {
    proc stop {args} { return -code break }
    check_refused { espdiff trajectory -mol $adk -sel protein -frames 0:1:3 -map none -csv $scratch/broken.csv {*}$quick \
        -callback stop } {ESPDIFF CANCELLED} "resume"
}

test "map none compares shapes, in compare as in trajectory" {
    set shapes [espdiff compare [list mol $adk frame 0 sel protein map none] [list mol $adk frame 4 sel protein map none] {*}$quick]
    check_equal unit [espdiff result $shapes potential_unit] ""
    espdiff delete $shapes
}

test "an endpoint without molecule or file is told so" {
    check_refused { espdiff compare {sel protein} [list mol $adk] } {ESPDIFF INPUT} "neither `mol ID`" "source"
}

test "a grid that is too fine has a readable size" {
    if {![catch { espdiff compare [list mol $adk frame 0 sel protein map none] \
        [list mol $adk frame 4 sel protein map none] -grid-spacing 0.01 } message]} { error "not refused" }
    check "short: $message" {![regexp {\d{5,}\.\d{4,}} $message]}
}

finish
