# all.tcl: runs every test file, each in a tclsh of its own; fails when one does.
set failed {}
foreach path [lsort [glob -directory [file dirname [file normalize [info script]]] *.test]] {
    if {[catch { exec [info nameofexecutable] $path >@ stdout 2>@ stderr }]} { lappend failed [file tail $path] }
}
if {[llength $failed] > 0} { puts "FAILED: [join $failed {, }]"; exit 1 }
