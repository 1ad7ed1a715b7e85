# guide.tcl: the commands of docs/guide.md as they stand, in its order, and that its pictures are there.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

foreach folder {pair_tim_maps traj_adk} {
    foreach path [glob [file join $data $folder *]] { file link -symbolic [file join $scratch [file tail $path]] $path }
}
cd $scratch

test "two states are loaded, with their maps" {
    eval [block guide.md "guide: load"]
    check_equal "maps" [list [molinfo 0 get numvolumedata] [molinfo 1 get numvolumedata]] {1 1}
}
test "linked views from the console" {
    eval [block guide.md "guide: linked"]
    check_equal "molecules are as they were" [molinfo list] {0 1}
}
test "the numbers that the guide names" {
    check_close "mean" [espdiff result $tim mean_abs_difference] 0.84 0.01
    check_close "sign" [expr {100 * [espdiff result $tim sign_change_area_fraction]}] 29.9 0.005
}
test "a picture, and the files of the result" {
    eval [block guide.md "guide: picture"]
    foreach name {tim.tga tim.json tim.residues.csv tim.vtp} { check $name {[file size $name] > 1000} }
    espdiff delete $tim
}
test "the command line draws it as well" {
    set channel [open [file join $env(ESPDIFF_TESTS) .. .. docs guide.md]]
    fconfigure $channel -encoding utf-8
    set guide [read $channel]
    close $channel
    if {![regexp {\n    espdiff (render [^\n]*)\n} $guide -> words]} { error "the guide has no `espdiff render`" }
    if {[catch { exec $env(ESPDIFF) {*}$words 2>@1 } message]} {
        # A build without VTK says so; the command is there all the same.
        check "without VTK" {[string match "*VTK*" $message]}
    } else {
        check "tim_again.png" {[file size tim_again.png] > 1000}
    }
}
test "the trajectory of the guide" {
    eval [block guide.md "guide: trajectory"]
    check_equal frames [molinfo $adk get numframes] 98
}
test "each picture is there" {
    foreach {all picture} [regexp -all -inline {\]\((images/[^)]*)\)} $guide] {
        set path [file join $env(ESPDIFF_TESTS) .. .. docs $picture]
        check "the picture is there" {[file exists $path]}
    }
}

finish
