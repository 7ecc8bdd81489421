"""Which of our modules stands in for each module of the real packages that has no file of its own here."""

MODULES = {
    "launch._entities": {
        "launch": (
            "action condition event event_handler invalid_launch_file_error launch_description_entity "
            "some_entities_type some_substitutions_type substitution"
        ),
        "launch.events": "execution_complete",
        "launch.substitutions": "substitution_failure text_substitution",
        "launch.utilities": "normalize_to_list_of_entities_impl",
    },
    "launch.utilities": {
        "launch.utilities": (
            "class_tools_impl ensure_argument_type_impl normalize_to_list_of_substitutions_impl "
            "perform_substitutions_impl type_utils visit_all_entities_and_collect_futures_impl"
        ),
    },
    "launch.conditions": {
        "launch.conditions": (
            "evaluate_condition_expression_impl if_condition invalid_condition_expression_error "
            "launch_configuration_equals launch_configuration_not_equals unless_condition"
        ),
    },
    "launch.descriptions": {
        "launch.descriptions": "executable",
    },
    "launch.events": {
        "launch.events": "include_launch_description matchers process shutdown timer_event",
        "launch.events.process": (
            "process_exited process_io process_matchers process_started process_stderr process_stdin "
            "process_stdout process_targeted_event running_process_event shutdown_process signal_process"
        ),
    },
    "launch.event_handlers": {
        "launch.event_handlers": (
            "event_named on_action_event_base on_execution_complete on_include_launch_description "
            "on_process_exit on_process_io on_process_start on_shutdown"
        ),
    },
    "launch.launch_description_sources": {
        "": "launch_xml launch_yaml",
        "launch": "launch_description_source",
        "launch.launch_description_sources": (
            "any_launch_description_source any_launch_file_utilities frontend_launch_description_source "
            "frontend_launch_file_utilities python_launch_description_source python_launch_file_utilities"
        ),
        "launch_xml": "launch_description_sources",
        "launch_xml.launch_description_sources": "xml_launch_description_source",
        "launch_yaml": "launch_description_sources",
        "launch_yaml.launch_description_sources": "yaml_launch_description_source",
    },
    "launch.substitutions._lookup": {
        "launch.substitutions": (
            "anon_name command environment_variable file_content find_executable launch_configuration "
            "launch_log_dir local_substitution path_join_substitution this_launch_file this_launch_file_dir"
        ),
    },
    "launch.substitutions._logic": {
        "launch.substitutions": (
            "boolean_substitution equals_substitution if_else_substitution not_equals_substitution python_expression"
        ),
    },
    "launch.actions._scope": {
        "launch.actions": (
            "append_environment_variable declare_launch_argument pop_environment pop_launch_configurations "
            "push_environment push_launch_configurations reset_environment reset_launch_configurations "
            "set_environment_variable set_launch_configuration unset_environment_variable "
            "unset_launch_configuration"
        ),
    },
    "launch.actions._events": {
        "launch.actions": "emit_event register_event_handler timer_action unregister_event_handler",
    },
    "launch.actions._composition": {
        "launch.actions": "group_action include_launch_description log_info opaque_function shutdown_action",
    },
    "launch.actions._process": {
        "launch.actions": "execute_local execute_process",
    },
    "launch_ros.substitutions": {
        "launch_ros.substitutions": "executable_in_package find_package parameter",
    },
    "launch_ros.descriptions": {
        "launch_ros.descriptions": "composable_node",
    },
    "launch_ros.parameter_descriptions": {
        "launch_ros.utilities": "evaluate_parameters normalize_parameters",
    },
    "launch_ros.utilities": {
        "launch_ros.utilities": "namespace_utils normalize_remap_rule",
    },
    "launch_ros.events": {
        "launch_ros.events": "lifecycle matchers",
        "launch_ros.events.matchers": "matches_node_name",
        "launch_ros.events.lifecycle": "change_state lifecycle_node_matchers state_transition",
    },
    "launch_ros.actions._node": {
        "launch_ros.actions": "node",
    },
    "launch_ros.actions._composable": {
        "launch_ros.actions": "composable_node_container load_composable_nodes",
    },
    "launch_ros.actions._lifecycle": {
        "launch_ros": "event_handlers",
        "launch_ros.actions": "lifecycle_node lifecycle_transition",
        "launch_ros.event_handlers": "on_state_transition",
    },
    "launch_ros.actions._settings": {
        "launch_ros.actions": (
            "push_ros_namespace ros_timer set_parameter set_parameters_from_file set_remap set_ros_log_dir "
            "set_use_sim_time"
        ),
    },
}
"""Maps each of our modules to the real packages' modules whose names it defines, grouped by package."""
