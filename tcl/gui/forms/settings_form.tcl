# settings_form.tcl: all settings of a comparison, behind a button, from the core's table.

namespace eval ::espdiff::gui {
    variable setting   ;# values by name
    variable standard  ;# default values by name
    array set setting {}
    array set standard {}

    # Small groups of the table share a page.
    variable setting_pages {General {Molecules Potentials Computation Verdict} Input {Structures Charges Region Fields} Surface Surface
        {Salt water} {{Salt water}} Mapping {Mapping {Mapping by morph}} Deform {{Mapping by deform}} Regularization Regularization}

    # The core's settings and those of the commands that compute.
    proc all_settings {} {
        set rows [::espdiff::core::settings]
        foreach row [::espdiff::core::study_settings computing] {
            if {[dict get $row name] eq "device"} { dict set row choices [device_choices] }
            lappend rows $row
        }
        foreach row [::espdiff::core::potential_settings] {
            if {"pb" in [dict get $row of]} { lappend rows [dict merge $row {group "Salt water" potential pb}] }
        }
        return $rows
    }

    # Lists several GPUs by name. They are detected once.
    proc device_choices {} {
        variable known_devices
        if {[info exists known_devices]} { return $known_devices }
        set choices {auto cpu cuda}
        foreach back_end [::espdiff::core::back_ends] {
            foreach gpu [dict get $back_end devices] { lappend gpus [dict get $gpu name] }
        }
        if {[info exists gpus] && [llength $gpus] > 1} { lappend choices {*}$gpus }
        return [set known_devices $choices]
    }

    proc build_settings {path} {
        variable widget
        variable setting
        variable standard
        variable setting_pages
        ttk::frame $path
        ttk::button $path.toggle -style Toolbutton -command ::espdiff::gui::toggle_settings -underline 2
        set widget(settings_toggle) [tip $path.toggle "How surfaces are made and mapped (Alt-S)"]
        set widget(settings) [ttk::notebook $path.pages]
        ttk::notebook::enableTraversal $path.pages
        grid $path.toggle [build_presets $path.presets] -sticky w
        grid configure $path.presets -column 2
        grid columnconfigure $path 0 -weight 1
        foreach row [all_settings] {
            set name [dict get $row name]
            set standard($name) [dict get $row default]
            if {![info exists setting($name)]} { set setting($name) $standard($name) }
        }
        foreach {title groups} $setting_pages {
            set page [ttk::frame $path.pages.[string map {" " _} [string tolower $title]] -padding 8]
            $path.pages add $page -text $title
            build_setting_page $page $groups
        }
        button $path.defaults Defaults ::espdiff::gui::restore_settings 2
        grid rowconfigure $path 0 -minsize [winfo reqheight $path.defaults]
        tip $path.defaults "Set all settings back to their defaults"
        set widget(defaults) $path.defaults
        trace add variable setting write ::espdiff::gui::count_changes
        bind [winfo toplevel $path] <Alt-s> [list $path.toggle invoke]
        count_changes
        return $path
    }

    # Two columns of rows with space between them.
    proc build_setting_page {page groups} {
        set rows {}
        foreach row [all_settings] { if {[dict get $row group] in $groups} { lappend rows $row } }
        set half [expr {([llength $rows] + 1) / 2}]
        set i 0
        foreach row $rows {
            set column [expr {$i < $half ? 0 : 3}]
            build_setting $page $row [expr {$i % $half}] $column
            incr i
        }
        grid columnconfigure $page 2 -minsize 20
        grid columnconfigure $page {1 4} -weight 1
    }

    proc build_setting {page row grid_row column} {
        variable widget
        dict with row {}
        set path $page.$name
        set variable ::espdiff::gui::setting($name)
        switch $kind {
            choice { ttk::combobox $path -textvariable $variable -values $choices -state readonly -width 9 }
            boolean { ttk::checkbutton $path -variable $variable }
            default { ttk::entry $path -textvariable $variable -width 10 }
        }
        set widget(setting,$name) $path
        if {$name eq "field"} { set path [build_field_menu $path] }
        if {$accepts ne ""} { append help "; $accepts" }
        form_row $page $grid_row [setting_label $name] $path "$help (default $default)" $column
    }

    # Fields to choose from beside the entry: the kinds, and in VMD the atoms' own values.
    proc build_field_menu {entry} {
        set frame [ttk::frame [winfo parent $entry].field_row]
        ttk::menubutton $frame.add -text Add -menu $frame.add.menu
        menu $frame.add.menu -tearoff 0
        foreach kind [::espdiff::core::field_kinds] {
            # Some take an argument, which is typed, or come with `interface`; VMD's atoms have the last three below.
            if {$kind in {residues atoms given map distance complementarity}} continue
            if {[in_vmd] && $kind in {b-factor occupancy confidence}} continue
            $frame.add.menu add command -label $kind -command [list ::espdiff::gui::add_field $kind]
        }
        if {[in_vmd]} {
            $frame.add.menu add cascade -label "Atoms' values in VMD" -menu $frame.add.menu.vmd
            menu $frame.add.menu.vmd -tearoff 0
            foreach name $::espdiff::vmd_fields {
                set kind [expr {$name in [::espdiff::core::field_kinds] ? "given:$name" : ""}]
                $frame.add.menu.vmd add command -label $name -command [list ::espdiff::gui::add_field $name $kind]
            }
        }
        tip $frame.add "Compare another quantity as well; its name and kind are added to the list, NAME KIND"
        lower $frame $entry
        pack $entry -in $frame -side left -fill x -expand 1
        pack $frame.add -side left -padx {4 0}
        return $frame
    }

    # Adds NAME KIND to the list of fields, once.
    proc add_field {name {kind ""}} {
        variable setting
        set fields [string trim $setting(field)]
        if {![string is list $fields]} { error "Field: '$fields' is not a list NAME KIND ...; clear it first" }
        if {[llength $fields] == 1} { lappend fields {} }
        if {[dict exists $fields $name]} return
        set setting(field) [concat $fields [list $name $kind]]
    }

    # What a setting's field is called; those of the regularization stand on a page of that name.
    proc setting_label {name} {
        regsub {^regularize-} $name "" label
        return [string totitle [string map {- " " _ " "} $label] 0 0]
    }

    # An option as the window's messages name it: by the label of its field, with the value that is advised.
    proc option_label {name value switch} {
        set labels {source-map "the source's Potential" target-map "the target's Potential"
            source-map-unit "the source's Unit" target-map-unit "the target's Unit"}
        if {[dict exists $labels $name]} { return [dict get $labels $name] }
        if {$name eq "potential"} {
            variable computed
            return "Potential [::espdiff::value_or [lreverse $computed] $value $value]"
        }
        set label -$name
        foreach row [all_settings] {
            if {[dict get $row name] ne $name} continue
            set label [setting_label $name]
            if {[string match regularize-* $name]} { set label "Regularization: $label" }
        }
        if {$value eq "" && $switch && [string match -* $label]} { set value 1 }
        return [expr {$value eq "" ? $label : "$label $value"}]
    }

    # Evaluates a script whose errors name the window's fields. Returns catch's code, and result and options.
    proc catch_labelled {script result_name options_name} {
        upvar 1 $result_name result $options_name options
        set before $::espdiff::option_spelling
        set ::espdiff::option_spelling ::espdiff::gui::option_label
        set code [catch { uplevel 1 $script } result options]
        set ::espdiff::option_spelling $before
        return $code
    }

    # The script's result, with options in it named so too.
    proc labelled {script} {
        set code [catch_labelled { uplevel 1 $script } result options]
        return -options [dict incr options -level] $result
    }

    proc toggle_settings {} {
        variable widget
        if {[winfo manager $widget(settings)] eq ""} {
            grid $widget(settings) -row 1 -columnspan 3 -sticky ew
            grid $widget(defaults) -row 0 -column 1 -sticky e
            raise $widget(defaults) $widget(settings_toggle)
        } else {
            grid forget $widget(settings) $widget(defaults)
        }
        count_changes
    }

    # Poisson-Boltzmann with the settings that differ from their defaults, as an endpoint's map: pb, or
    # {pb ionic_strength 0.05}.
    proc salt_water_map {} {
        variable setting
        variable standard
        set map pb
        foreach row [all_settings] {
            set name [dict get $row name]
            if {![dict exists $row potential] || [string trim $setting($name)] eq $standard($name)} continue
            lappend map $name [string trim $setting($name)]
        }
        return $map
    }

    proc restore_settings {} {
        variable setting
        variable standard
        foreach name [array names standard] { set setting($name) $standard($name) }
    }

    # The settings that differ from their defaults, as options of `espdiff compare`, or of a command that takes some of
    # them (see takes_setting).
    proc setting_options {{wanted all}} {
        variable setting
        variable standard
        set options {}
        foreach row [all_settings] {
            if {[dict exists $row potential]} continue
            set name [dict get $row name]
            set of_command [expr {![dict exists $row surface]}]
            if {$of_command ? $wanted eq "preparation" : ![::espdiff::takes_setting $wanted $row]} continue
            set value [string trim $setting($name)]
            if {$value ne $standard($name)} { lappend options -$name $value }
        }
        return $options
    }

    # The button's title reports changes while the settings are hidden.
    proc count_changes {args} {
        variable widget
        set n [expr {([llength [setting_options]] + [llength [salt_water_map]] - 1) / 2}]
        set arrow [expr {[winfo manager $widget(settings)] eq "" ? "\u25b8" : "\u25be"}]
        $widget(settings_toggle) configure \
            -text "$arrow Settings[expr {$n == 0 ? " (all at their defaults)" : " ($n changed)"}]"
        show_preset
        clear_error pair
    }

    proc forget_settings {} { trace remove variable ::espdiff::gui::setting write ::espdiff::gui::count_changes }
}
