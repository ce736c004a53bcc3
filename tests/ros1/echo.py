"""Answers joint states with a command to hold them: what rospy alone takes, for the benchmark."""

import rospy
from baxter_core_msgs.msg import JointCommand
from sensor_msgs.msg import JointState


def main():
    rospy.init_node("echo", disable_signals=True)
    name = "/robot/limb/left/joint_command"
    publisher = rospy.Publisher(name, JointCommand, queue_size=1, tcp_nodelay=True)

    def answer(state):
        joints = [(n, q) for n, q in zip(state.name, state.position) if n.startswith("left_")]
        if joints:
            names, command = zip(*joints)
            publisher.publish(JointCommand(mode=1, command=command, names=names))

    rospy.Subscriber("/robot/joint_states", JointState, answer, queue_size=1, tcp_nodelay=True)
    rospy.spin()


if __name__ == "__main__":
    main()
