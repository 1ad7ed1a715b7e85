# menu.tcl: the window as VMD's menu opens it: closing, highlights, colours of atoms, errors, the session's script.
source [file join $env(ESPDIFF_TESTS) support.tcl]
source [file join $env(ESPDIFF_TESTS) window_support.tcl]
vmd_install_extension espdiff espdiff_tk "Analysis/Surface Potential Comparison"

# What the window manager does when the user presses the window's close button.
proc close_button {} { uplevel #0 [wm protocol .espdiff WM_DELETE_WINDOW]; update }

load_tim
menu espdiff on
update
array set ::espdiff::gui::setting {grid-spacing 2}

test "compared as the menu's window offers it" {
    check_equal state [wm state .espdiff] normal
    press compare
    wait_until {$::espdiff::gui::running eq ""}
    set first $::espdiff::gui::shown
    check "a result" {$first ne ""}
}

test "the result says what it came from, whatever the form says now" {
    tab pair
    set origin [[widget result,origin] cget -text]
    check "source: $origin" {[string match "Source $source: scTIM_chainA.pqr, frame 0, atoms*potential: data set 0*" $origin]}
    form target,frame 7 target,map none
    check_equal "the same" [[widget result,origin] cget -text] $origin
    form target,frame now
}

test "Potential: automatic is explained, and nothing below moves" {
    ::espdiff::gui::update_endpoint target
    set y [winfo rooty [widget settings_toggle]]
    foreach choice {automatic none "0: dTIM_chainA_pot-PE0.dx" automatic} {
        form target,map $choice
        ::espdiff::gui::update_endpoint target
        update
        check_equal "$choice: y" [winfo rooty [widget settings_toggle]] $y
    }
    check "said: [[widget target,choice] cget -text]" {[string match "Poisson-Boltzmann: *" [[widget target,choice] cget -text]]}
    form target,map "0: dTIM_chainA_pot-PE0.dx"
    ::espdiff::gui::update_endpoint target
}

test "the time left is told once it can be" {
    check_equal early [::espdiff::gui::time_left [clock milliseconds] 0.5] ""
    check_equal half [::espdiff::gui::time_left [expr {[clock milliseconds] - 30000}] 0.5] ", about 30 s left"
    check_equal minutes [::espdiff::gui::time_left [expr {[clock milliseconds] - 30000}] 0.1] ", about 5 min left"
}

test "the close button ends runs, removes the highlight and saves the settings" {
    tab residues
    [widget residues,table] selection set [lindex [[widget residues,table] children {}] 0]
    update
    check_equal highlighted [molinfo $source get numreps] 2
    array set ::espdiff::gui::setting {grid-spacing 0.5}
    tab pair
    press compare
    pause 200
    set handle $::espdiff::gui::running
    check "it runs" {$handle ne ""}
    with_yes { close_button }
    check_equal state [wm state .espdiff] withdrawn
    check "no run" {$handle ni [espdiff handles]}
    check_equal "no highlight" [list [molinfo $source get numreps] [molinfo $target get numreps]] {1 1}
    check_equal "no trace" [lsearch -all -inline [concat {*}[trace info variable ::vmd_molecule]] *gui*] {}
    set channel [open [file join $env(HOME) .config espdiff window]]
    check "settings" {[string match "*setting grid-spacing 0.5\n*" [read $channel]]}
    close $channel
}

test "the menu opens it again, with its result" {
    menu espdiff on
    update
    check_equal state [wm state .espdiff] normal
    check_equal result $::espdiff::gui::shown $first
    check "Compare" {[[widget compare] instate !disabled]}
    set more [mol new [input pair_tim_maps/scTIM_chainA.pqr] type pqr waitfor all]
    pause 150
    check "its molecules are current" {"$more: scTIM_chainA.pqr" in [[widget source,mol] cget -values]}
    mol delete $more
    pause 150
}

test "`menu espdiff off` does the same, and asks nothing" {
    press compare
    pause 100
    set handle $::espdiff::gui::running
    menu espdiff off
    pause 200
    check "no run" {$handle ne "" && $handle ni [espdiff handles]}
    menu espdiff on
    update
    array set ::espdiff::gui::setting {grid-spacing 2}
}

test "a highlight does not move to another protein's residue" {
    tab residues
    [widget residues,table] selection set 5
    update
    check_equal highlighted [molinfo $source get numreps] 2
    tab pair
    press swap
    press compare
    wait_until {$::espdiff::gui::running eq ""}
    check "another one" {$::espdiff::gui::shown ne $first}
    check_equal "nobody chose a residue of it" [[widget residues,table] selection] {}
    check_equal "no highlight" [list [molinfo $source get numreps] [molinfo $target get numreps]] {1 1}
    press swap
}

test "it stays with its residue in another result of the same protein" {
    espdiff::gui::show_results $first
    tab residues
    set chosen [lindex [[widget residues,table] children {}] 3]
    [widget residues,table] selection set $chosen
    update
    set name [[widget residues,table] set $chosen residue]
    tab pair
    press compare
    wait_until {$::espdiff::gui::running eq ""}
    update
    set now [[widget residues,table] selection]
    check_equal name [[widget residues,table] set $now residue] $name
    check_equal highlighted [molinfo $source get numreps] 2
}

test "Colour atoms: the displayed molecule, not the highlight, with a legend; and back" {
    tab residues
    mol off $source
    set highlight [lindex [molinfo $target get "{color 1}"] 0]
    set before [list [molinfo $source get "{color 0}"] [molinfo $target get "{color 0}"]]
    set n [molinfo num]
    press residues,atoms
    check_equal source [molinfo $source get "{color 0}"] [lindex $before 0]
    check_equal target [molinfo $target get "{color 0}"] User
    check_equal highlight [lindex [molinfo $target get "{color 1}"] 0] $highlight
    check_equal legend [expr {[molinfo num] - $n}] 1
    press residues,uncolor
    check_equal colours [list [molinfo $source get "{color 0}"] [molinfo $target get "{color 0}"]] $before
    check_equal "no legend" [molinfo num] $n
    mol off $target
    press residues,atoms
    check "told" {[string match "*hidden; show one*" [[widget residues,message] cget -text]]}
    mol on $source
    press residues,atoms
    check "the error is gone" {[string match "Molecule $source is coloured*" [[widget residues,message] cget -text]]}
    press residues,uncolor
    mol on $target
}

test "the buttons of the residues do not move with the text below them" {
    press residues,clear
    set y [winfo rooty [widget residues,atoms]]
    [widget residues,table] selection set 7
    update
    check_equal y [winfo rooty [widget residues,atoms]] $y
    press residues,clear
}

test "an error disappears with its cause" {
    tab pair
    set mol $::espdiff::gui::form(target,mol)
    form target,mol ""
    press compare
    check "told" {[string match "*no molecule is chosen*" [message_line]]}
    form target,mol $mol
    ::espdiff::gui::guard ::espdiff::gui::choose_molecule target
    check_equal message [message_line] ""
    [widget target,map] current 3
    ::espdiff::gui::guard ::espdiff::gui::update_endpoint target
}

test "a residue of a hidden molecule is not said to be highlighted" {
    mol off $source
    mol off $target
    check_refused { espdiff highlight $first 5 } {ESPDIFF INPUT} hidden "mol on"
    mol on $source
    check_equal molecules [espdiff highlight $first 5] [list $source $target]
    espdiff highlight $first {}
    mol on $target
}

test "the script of the session runs in a fresh VMD in text mode, elsewhere" {
    espdiff::gui::show_results $first
    press draw
    set script [::espdiff::gui::session_text]
    set channel [open $scratch/session.tcl w]
    puts $channel "lappend auto_path {[file join $env(VMDPLUGINPATH) tcl]}\n$script"
    puts $channel "set channel \[open {$scratch/number} w\]"
    puts $channel {puts $channel [list [espdiff result $comparison rms_difference] [molinfo num]]}
    puts $channel "close \$channel\nquit"
    close $channel
    # Ids differ there.
    set fresh [open $scratch/fresh.tcl w]
    puts $fresh "mol new\nmol delete 0\nsource {$scratch/session.tcl}"
    close $fresh
    file mkdir $scratch/elsewhere
    cd $scratch/elsewhere
    set vmd [expr {[info exists env(VMD)] ? $env(VMD) : "vmd"}]
    set code [catch { exec $vmd -dispdev text -e $scratch/fresh.tcl < /dev/null 2>@1 } log]
    check "it ran: [string range $log end-600 end]" {[file exists $scratch/number]}
    set channel [open $scratch/number]
    lassign [read $channel] number molecules
    close $channel
    check_equal "the number" $number [espdiff result $first rms_difference]
    check "drawn there too" {$molecules > 2}
    press undraw
}

test "no callback failed" { check_equal errors $background {} }

espdiff delete all
finish
