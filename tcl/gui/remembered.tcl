# remembered.tcl: saves the user's entries between sessions in a file.

namespace eval ::espdiff::gui {
    # Form fields that make sense in another session (no molecules, files or frames of this one): a text, a switch, or
    # one of these words.
    variable remembered {
        source,sel text target,sel text matrix,sel text trajectory,sel text trajectory,frames text
        matrix,output text ensemble,output text ensemble,sel text trajectory,csv text draw,low text draw,high text draw,limit text
        draw,legend switch matrix,ordered switch trajectory,skip switch
        residues,falling switch residues,face switch residues,least text draw,range {auto given} draw,surface {target source}
        draw,color {difference sign source target slip displacement path_length why none}
        draw,uncertain {fade transparent plain} draw,off_target {uncertain mark hide} draw,colors {red-blue cool-warm purple-orange} draw,view {single linked}
        matrix,potential {none automatic Poisson-Boltzmann "PME, explicit water" "Coulomb, vacuum" "data set 0 of each"}
        ensemble,potential {automatic Poisson-Boltzmann "PME, explicit water" "Coulomb, vacuum"}
        ensemble,control {TFCE max-t} trajectory,against {"the frame" "the frame before"} residues,sort text
    }
    variable remembered_head "# espdiff: settings of the window, version 1"
    variable were_read 0  ;# the file is read once per session

    proc settings_file {} {
        global env tcl_platform
        if {[info exists env(XDG_CONFIG_HOME)] && $env(XDG_CONFIG_HOME) ne ""} {
            set folder $env(XDG_CONFIG_HOME)
        } elseif {$tcl_platform(platform) eq "windows" && [info exists env(APPDATA)]} {
            set folder $env(APPDATA)
        } elseif {[info exists env(HOME)] && $env(HOME) ne ""} {
            set folder [file join $env(HOME) .config]
        } else {
            return ""
        }
        return [file join $folder espdiff window]
    }

    # One line for each field and each setting that differs from its default: `form NAME VALUE`, `setting NAME VALUE`.
    proc settings_text {} {
        variable form
        variable remembered
        variable remembered_head
        set lines [list $remembered_head]
        foreach name [dict keys $remembered] {
            if { [string match "*\n*" $form($name)]} continue
            lappend lines [list form $name $form($name)]
        }
        foreach {option value} [setting_options] { lappend lines [list setting [string range $option 1 end] $value] }
        return [join $lines \n]\n
    }

    # A window that cannot save its settings still works.
    proc save_settings {args} {
        set path [settings_file]
        if {$path eq ""} return
        if {[catch {
            file mkdir [file dirname $path]
            write_whole_file $path [settings_text]
        } message]} { show_message "The window's settings cannot be saved: $message" error }
    }

    # Read when the window first opens. A foreign or damaged file changes nothing.
    proc load_settings {} {
        variable were_read
        if {$were_read} return
        set were_read 1
        set path [settings_file]
        if {$path eq "" || ![file exists $path]} return
        if {[catch { parse_settings [read_whole_file $path] } entries]} {
            show_message "The window's settings in '$path' are ignored: $entries. They are written anew when the window\
                is closed." error
            return
        }
        foreach {array name value} $entries { set ::espdiff::gui::${array}($name) $value }
    }

    # The file's content, fully checked: array, name, value, ... Names unknown to this version are ignored.
    proc parse_settings {text} {
        variable remembered
        variable remembered_head
        variable standard
        set lines [split [string trimright $text \n] \n]
        if {[lindex $lines 0] ne $remembered_head} { error "its first line is not '$remembered_head'" }
        set entries {}
        set number 1
        foreach line [lrange $lines 1 end] {
            incr number
            if {[catch { llength $line } n] || $n != 3 || [lindex $line 0] ni {form setting}} {
                error "line $number is damaged"
            }
            lassign $line array name value
            if {$array eq "form" && ![dict exists $remembered $name]} continue
            if {$array eq "setting" && ![info exists standard($name)]} continue
            if {![is_possible $array $name $value]} { error "line $number: '$value' is not a value of $name" }
            lappend entries $array $name $value
        }
        return $entries
    }

    # Checks a setting with its command.
    proc is_possible {array name value} {
        variable remembered
        if {$array eq "setting"} {
            foreach option [::espdiff::options_of compare] {
                if {[dict get $option name] ne "-$name"} continue
                return [expr {![catch { ::espdiff::check_value $option $value }]}]
            }
        }
        switch -- [set kind [dict get $remembered $name]] {
            text { return 1 }
            switch { return [expr {$value in {0 1}}] }
            default { return [expr {$value in $kind}] }
        }
    }

    proc read_whole_file {path} {
        set channel [::espdiff::open_file $path]
        fconfigure $channel -encoding utf-8
        ::espdiff::finally { return [read $channel] } { close $channel }
    }

    # Writes under another name first, so that no reader or crash ever leaves half a file.
    proc write_whole_file {path text} {
        set new $path.[pid].new
        if {[catch {
            set channel [::espdiff::open_file $new w]
            fconfigure $channel -encoding utf-8 -translation lf
            puts -nonewline $channel $text
            close $channel
            file rename -force $new $path
        } message]} {
            catch { close $channel }
            file delete $new
            error "'$path' cannot be written ($message)"
        }
    }
}
