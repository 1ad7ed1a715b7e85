# manual.tcl: the manual's first script as it stands, on molecules that VMD holds: it prints what the manual says.
source [file join $env(ESPDIFF_TESTS) support.tcl]

test "the first script runs unchanged, and prints the same as on files" {
    foreach path [glob [file join $data pair_tim_maps *]] { file link -symbolic [file join $scratch [file tail $path]] $path }
    cd $scratch
    set channel [open first.tcl w]
    puts $channel [block tcl.md "example: first.tcl"]
    close $channel
    # What the script prints, as VMD says a lot beside it.
    rename puts real_puts
    proc puts {args} {
        if {[llength $args] == 1} { append ::printed [lindex $args 0] \n }
        real_puts {*}$args
    }
    set printed ""
    source first.tcl
    rename puts {}
    rename real_puts puts
    check_equal "printed" [string trim $printed] [string trim [block tcl.md "output: first.tcl"]]
    foreach file {tim.json tim.vtp tim.residues.csv} { check "$file" {[file exists $file]} }
    check "drawn" {[llength [molinfo list]] > 2}
    check_equal "molecules and not files" [string match "mol 0 *" [dict get [lindex [espdiff result $tim inputs] 0] path]] 1
}

finish
